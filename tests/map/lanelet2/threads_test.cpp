#include <fmt/format.h>
#include <gtest/gtest.h>

#include <string>

#include "roadbed/map/compiled/compiled_map.h"
#include "roadbed/map/lanelet2/read.h"
#include "roadbed/tests/support/refusal_of.h"

namespace roadbed::map {
namespace {

// Lanelets behind each other, more than are built, and long enough to be read, at once; of some,
// things are missing.
std::string many_lanelets() {
  constexpr int kLanelets = 15'000;
  std::string nodes, ways, relations;
  for (int i = 0; i <= kLanelets; ++i) {
    for (int side = 0; side < 2; ++side) {
      nodes += i % 700 == 3 ? fmt::format("<node id='{}'/>\n", 1 + 2 * i + side)
                            : fmt::format("<node id='{}' lat='{:.7f}' lon='{:.7f}'/>\n",
                                          1 + 2 * i + side, 49.0 + 1e-5 * i, 8.4 + 3e-5 * side);
      ways += fmt::format("<way id='{}'><nd ref='{}'/><nd ref='{}'/></way>\n",
                          100'001 + 2 * i + side, 1 + 2 * i + side, 3 + 2 * i + side);
    }
    relations += fmt::format(
        "<relation id='{}'><member type='way' ref='{}' role='left'/>"
        "<member type='way' ref='{}' role='right'/><tag k='type' v='lanelet'/></relation>\n",
        200'001 + i, 100'001 + 2 * i, i % 500 == 7 ? 1 : 100'002 + 2 * i);
  }
  return "<osm>\n" + nodes + ways + relations + "</osm>\n";
}

void expect_the_same_for_any_number(const std::string& text) {
  const std::string one = write_compiled_map(RoadMap(lanelet2::read(text, "many.osm")));
  for (const int threads : {2, 3}) {
    const RoadMap road_map(lanelet2::read(text, "many.osm", threads));
    EXPECT_GT(road_map.lanes().size(), 14'000u);
    EXPECT_GT(road_map.import_diagnostics().size(), 20u);
    EXPECT_EQ(write_compiled_map(road_map), one);
  }
}

TEST(Lanelet2Threads, ReadTheSameMapForAnyNumber) {
  expect_the_same_for_any_number(many_lanelets());
}

std::string replaced_from_middle(const std::string& text, const std::string& from,
                                 const std::string& to) {
  std::size_t begin = text.size() / 3;
  std::string made = text.substr(0, begin);
  for (std::size_t at; (at = text.find(from, begin)) != text.npos; begin = at + from.size()) {
    made += text.substr(begin, at - begin) + to;
  }
  return made + text.substr(begin);
}

// Where a stretch of the text would begin, an element only seems to.
TEST(Lanelet2Threads, TakeNoTextOfACommentForAnElement) {
  const std::string text = many_lanelets();
  expect_the_same_for_any_number(
      replaced_from_middle(text, "<way ", "<!-- <node id='1'/><node id='2' lat='a'/> --><way "));
  expect_the_same_for_any_number(
      replaced_from_middle(text, "</way>", "<![CDATA[<relation id='7'>]]></way>"));
  expect_the_same_for_any_number(
      replaced_from_middle(text, "<way ", "<create><node id='1'/></create><way "));
}

std::string refusal(const std::string& text, int threads) {
  return tests::refusal_of([&] { lanelet2::read(text, "many.osm", threads); });
}

TEST(Lanelet2Threads, RefuseTheSameInTheSameWords) {
  const std::string text = many_lanelets();
  std::string half = text.substr(0, text.size() / 2);
  half.resize(half.rfind("<way "));
  const std::string second = text.substr(text.find('\n') + 1);  // and the end of its first element
  for (const std::string& bad :
       {half, text + text, half + "</osm>\n" + second, half + "</way>" + text.substr(half.size()),
        replaced_from_middle(text, "ref='3", "ref=3")}) {
    const std::string one = refusal(bad, 1);
    EXPECT_NE(one, "accepted");
    for (const int threads : {2, 3}) EXPECT_EQ(refusal(bad, threads), one);
  }
}

}  // namespace
}  // namespace roadbed::map
