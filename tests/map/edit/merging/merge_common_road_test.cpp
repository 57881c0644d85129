#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "roadbed/geometry/polygons/polygon.h"
#include "roadbed/map/derived/map_diff.h"
#include "roadbed/map/edit/clipping/clip.h"
#include "roadbed/map/edit/merging/merge.h"
#include "roadbed/map/files/input_error.h"
#include "roadbed/map/files/read_file.h"
#include "roadbed/map/load_map.h"
#include "roadbed/tests/support/real_data.h"

namespace roadbed::map {
namespace {

std::string point(double x, double y) {
  return fmt::format("<point><x>{}</x><y>{}</y></point>", x, y);
}

// A straight lanelet with a sign, a car and a planning problem.
std::string scenario(double x, double y, double step_s = 0.1, const std::string& crs = "") {
  const std::string state = fmt::format(
      "<initialState><position>{}</position><orientation><exact>0</exact></orientation><time>"
      "<exact>0</exact></time><velocity><exact>1</exact></velocity></initialState>",
      point(x + 5, y + 1));
  return fmt::format(
      "<?xml version=\"1.0\"?>\n<commonRoad commonRoadVersion=\"2020a\" benchmarkID=\"ZAM_Made-1\" "
      "timeStepSize=\"{}\">\n  <location><geoTransformation><geoReference>{}</geoReference>"
      "</geoTransformation></location>\n  <lanelet id=\"1\"><leftBound>{}{}</leftBound><rightBound>"
      "{}{}</rightBound><laneletType>urban</laneletType><trafficSignRef ref=\"2\"/></lanelet>\n"
      "  <trafficSign id=\"2\"><trafficSignElement><trafficSignID>274</trafficSignID>"
      "<additionalValue>13.9</additionalValue></trafficSignElement><position>{}</position>"
      "<virtual>true</virtual></trafficSign>\n  <dynamicObstacle "
      "id=\"3\"><type>car</type><shape><rectangle><length>4"
      "</length><width>2</width></rectangle></shape>{}</dynamicObstacle>\n  <planningProblem "
      "id=\"4\">{}<goalState><position><lanelet ref=\"1\"/></position><time><intervalStart>1"
      "</intervalStart><intervalEnd>9</intervalEnd></time></goalState></planningProblem>\n"
      "</commonRoad>\n",
      step_s, crs, point(x, y + 2), point(x + 50, y + 2), point(x, y), point(x + 50, y),
      point(x + 5, y - 1), state, state);
}

std::size_t count_of(const std::string& text, const std::string& part) {
  std::size_t count = 0;
  for (std::size_t at = text.find(part); at != text.npos; at = text.find(part, at + 1)) ++count;
  return count;
}

TEST(MergeCommonRoad, GivesOtherIdsToOtherThingsAndToWhatNamesThem) {
  const Merged merged = merge({{scenario(0, 0), "a.xml"}, {scenario(200, 9), "b.xml"}});
  ASSERT_EQ(merged.renamed.size(), 4u);
  EXPECT_EQ(merged.renamed[0].file, "b.xml");
  EXPECT_EQ(merged.renamed[0].kind, "lanelet");
  EXPECT_EQ(merged.renamed[0].from, "1");
  EXPECT_EQ(merged.renamed[0].to, "5");
  EXPECT_EQ(count_of(merged.bytes, "<dynamicObstacle"), 2u);
  EXPECT_EQ(count_of(merged.bytes, "<lanelet ref=\"5\""), 1u);  // the second problem's goal
  const RoadMap map = parse_map(merged.bytes, "merged.xml");
  ASSERT_EQ(map.lanes().size(), 2u);
  EXPECT_EQ(map.signals().size(), 2u);
}

TEST(MergeCommonRoad, TakesOnceWhatIsTheSame) {
  const Merged merged = merge({{scenario(0, 0), "a.xml"}, {scenario(0, 0), "b.xml"}});
  EXPECT_TRUE(merged.renamed.empty());
  EXPECT_EQ(parse_map(merged.bytes, "merged.xml").lanes().size(), 1u);
  EXPECT_EQ(count_of(merged.bytes, "<planningProblem"), 1u);
}

// Of two problems that say the same each leads to its own lanelet.
TEST(MergeCommonRoad, TakesTwiceWhatLeadsToDifferentThings) {
  std::string other = scenario(0, 0);
  const std::string wider = point(50, 2), after = point(50, 3);
  other.replace(other.find(wider), wider.size(), after);
  const Merged merged = merge({{scenario(0, 0), "a.xml"}, {other, "b.xml"}});
  EXPECT_EQ(count_of(merged.bytes, "<lanelet id"), 2u);
  EXPECT_EQ(count_of(merged.bytes, "<planningProblem"), 2u);
  EXPECT_EQ(count_of(merged.bytes, "<trafficSign "), 1u);
  EXPECT_EQ(count_of(merged.bytes, "<lanelet ref=\"5\""), 1u);
}

TEST(MergeCommonRoad, LinksEndsThatCoincide) {
  const Merged merged = merge({{scenario(0, 0), "a.xml"}, {scenario(50.03, 0.01), "b.xml"}});
  ASSERT_EQ(merged.seams.size(), 1u);
  EXPECT_EQ(merged.seams[0].first, "end of lanelet 1");
  EXPECT_EQ(merged.seams[0].second, "start of lanelet 5");
  EXPECT_NEAR(merged.seams[0].gap_m, std::hypot(0.03, 0.01), 1e-9);
  const RoadMap map = parse_map(merged.bytes, "merged.xml");
  EXPECT_EQ(map.graph().of(map.lanes()[0].id).successors.size(), 1u);
  const Merged apart = merge({{scenario(0, 0), "a.xml"}, {scenario(50.1, 0), "b.xml"}});
  EXPECT_TRUE(apart.seams.empty());
}

TEST(MergeCommonRoad, SaysThatScenariosOfOtherTimeStepsAreLost) {
  const Merged merged = merge({{scenario(0, 0), "a.xml"}, {scenario(200, 9, 0.2), "b.xml"}});
  EXPECT_EQ(count_of(merged.bytes, "<dynamicObstacle"), 1u);
  EXPECT_EQ(count_of(merged.bytes, "<lanelet id"), 2u);
  const Count lost{"obstacles and planning problems of other time steps, left out", 2};
  EXPECT_EQ(merged.counts.back(), lost);
}

TEST(MergeCommonRoad, RefusesOtherSystems) {
  const std::vector<MergeInput> inputs = {{scenario(0, 0, 0.1, "EPSG:32632"), "a.xml"},
                                          {scenario(200, 9, 0.1, "EPSG:32633"), "b.xml"}};
  EXPECT_THROW(merge(inputs), InputError);
  EXPECT_EQ(parse_map(merge(inputs, {.same_system = true}).bytes, "a.xml").lanes().size(), 2u);
}

// Two lanelets beside each other and one that follows the first, cut at some x.
std::string street(double y = 0.0) {
  const auto lanelet = [&](int id, double x, double right_m, const std::string& links) {
    return fmt::format(
        "  <lanelet id=\"{}\"><leftBound>{}{}{}</leftBound><rightBound>{}{}{}</rightBound>{}"
        "<laneletType>urban</laneletType></lanelet>\n",
        id, point(x, right_m + 3), point(x + 20, right_m + 3), point(x + 40, right_m + 3),
        point(x, right_m), point(x + 20, right_m), point(x + 40, right_m), links);
  };
  return "<?xml version=\"1.0\"?>\n<commonRoad commonRoadVersion=\"2020a\" "
         "benchmarkID=\"ZAM_Made-1\" timeStepSize=\"0.1\">\n" +
         lanelet(1, 0, y + 3,
                 "<successor ref=\"3\"/><adjacentRight ref=\"2\" drivingDir=\"same\"/>") +
         lanelet(2, 0, y, "<adjacentLeft ref=\"1\" drivingDir=\"same\"/>") +
         lanelet(3, 40, y + 3, "<predecessor ref=\"1\"/>") + "</commonRoad>\n";
}

MergeInput stretch(const std::string& of, double from_m, double to_m) {
  const Region region({geometry::box_ring({from_m, -1e4}, {to_m, 1e4})});
  return {clip(of, "street.xml", region).bytes, fmt::format("from {}", from_m)};
}

const LaneLinks& links_of(const RoadMap& map, const char* lane) {
  return map.graph().of(map.find_lane(lane).value());
}

TEST(MergeCommonRoad, JoinsThePartsOfAClip) {
  const Merged merged =
      merge({stretch(street(), 23, 100), stretch(street(), -1, 7), stretch(street(), 7, 23)});
  EXPECT_TRUE(merged.renamed.empty());
  EXPECT_EQ(merged.bytes.find("roadbed-clip"), std::string::npos);
  EXPECT_TRUE(diff(parse_map(street(), "a.xml"), parse_map(merged.bytes, "b.xml")).empty());
}

TEST(MergeCommonRoad, KeepsPartsApartWhereOneIsMissing) {
  const Merged merged = merge({stretch(street(), -1, 7), stretch(street(), 23, 100)});
  const RoadMap map = parse_map(merged.bytes, "merged.xml");
  ASSERT_EQ(map.lanes().size(), 5u);
  EXPECT_EQ(merged.renamed.size(), 2u);
  EXPECT_NEAR(map.lane(*map.find_lane("1")).length_m(), 7.0, 1e-9);
  EXPECT_TRUE(links_of(map, "1").successors.empty());
  ASSERT_EQ(links_of(map, "3").predecessors.size(), 1u);
  const LaneId before = links_of(map, "3").predecessors.front();
  EXPECT_NEAR(map.lane(before).length_m(), 17.0, 1e-9);
  // Each part is beside the part that is as long.
  ASSERT_TRUE(links_of(map, "1").right);
  EXPECT_EQ(map.lane(links_of(map, "1").right->lane).name, "2");
  ASSERT_TRUE(map.graph().of(before).right);
  EXPECT_NEAR(map.lane(map.graph().of(before).right->lane).length_m(), 17.0, 1e-9);
  // With what is missing it is the whole.
  const Merged whole = merge({{merged.bytes, "merged.xml"}, stretch(street(), 7, 23)});
  EXPECT_TRUE(diff(parse_map(street(), "a.xml"), parse_map(whole.bytes, "b.xml")).empty());
}

// Maps of different places whose lanelets have the same ids.
TEST(MergeCommonRoad, JoinsNothingOfAnotherMap) {
  const Merged merged = merge({stretch(street(), -1, 7), stretch(street(90.0), 7, 100)});
  const RoadMap map = parse_map(merged.bytes, "merged.xml");
  EXPECT_EQ(map.lanes().size(), 5u);
  EXPECT_TRUE(links_of(map, "1").successors.empty());
  EXPECT_NEAR(map.lane(*map.find_lane("1")).length_m(), 7.0, 1e-9);
}

TEST(MergeCommonRoad, BelievesNoMemoryThatDoesNotFit) {
  std::string part = stretch(street(), -1, 7).bytes;
  const std::string rows = "rows=\"3\"", many = "rows=\"900000000000000\"";
  for (std::size_t at = part.find(rows); at != part.npos; at = part.find(rows, at + 1)) {
    part.replace(at, rows.size(), many);
  }
  const Merged merged = merge({{part, "a.xml"}, stretch(street(), 7, 100)});
  EXPECT_EQ(parse_map(merged.bytes, "merged.xml").lanes().size(), 5u);
}

// Halves of a map are the whole again: every lane is there, and leads on over the cut.
TEST(MergeCommonRoad, OfHalvesIsTheWhole) {
  const std::string bytes = read_file(tests::data_folder() / "junction.xml");
  const RoadMap whole = parse_map(bytes, "junction.xml");
  double middle_m = 0.0;
  for (const Lane& lane : whole.lanes()) {
    middle_m += whole.to_source(lane.left.in_map.points()[0]).x() /
                static_cast<double>(whole.lanes().size());
  }
  const Merged merged = merge({stretch(bytes, -1e4, middle_m), stretch(bytes, middle_m, 1e4)});
  EXPECT_FALSE(merged.seams.empty());
  EXPECT_TRUE(diff(whole, parse_map(merged.bytes, "merged.xml")).empty());
}

}  // namespace
}  // namespace roadbed::map
