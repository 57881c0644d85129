#include "roadbed/map/query/lane_question.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <random>
#include <set>
#include <string>
#include <vector>

#include "roadbed/map/load_map.h"
#include "roadbed/tests/support/made_road.h"
#include "roadbed/tests/support/real_data.h"

namespace roadbed::map {
namespace {

using testing::HasSubstr;
using Names = std::set<std::string>;

const RoadMap& town() {
  static const RoadMap map = load_map(tests::data_folder() / "town.xodr");
  return map;
}

Names ask(const std::string& question, const RoadMap& road_map = town()) {
  Names names;
  for (const LaneId id : lanes_that_fit(road_map, LaneQuestion(question))) {
    names.insert(road_map.lane(id).name);
  }
  return names;
}

template <typename Fits>
Names lanes_where(const Fits& fits, const RoadMap& road_map = town()) {
  Names names;
  for (const Lane& lane : road_map.lanes()) {
    if (fits(lane)) names.insert(lane.name);
  }
  return names;
}

TEST(LaneQuestion, AsksForWhatTheMapSays) {
  const auto fast = [](const Lane& lane) {
    const auto limit_mps = lane.least_speed_limit_mps();
    return lane.type == LaneType::driving && limit_mps && 3.6 * *limit_mps > 40.0;
  };
  EXPECT_EQ(ask("type = driving and speed > 40"), lanes_where(fast));
  EXPECT_FALSE(ask("type = driving and speed > 40").empty());
  EXPECT_EQ(ask("junction != none"), lanes_where([](const Lane& l) { return bool(l.junction); }));
  EXPECT_EQ(ask("length < 20"), lanes_where([](const Lane& l) { return l.length_m() < 20.0; }));
  EXPECT_EQ(ask("speed = none"),
            lanes_where([](const Lane& l) { return !l.least_speed_limit_mps(); }));
  EXPECT_EQ(ask("drivable = true"), lanes_where([](const Lane& l) { return is_drivable(l.type); }));
  EXPECT_EQ(ask("participants = bicycle"),
            lanes_where([](const Lane& l) { return l.participants.has(Participant::bicycle); }));
}

TEST(LaneQuestion, TakesNoneForNothingAndForWhatIsCalledSo) {
  tests::MadeRoad road;
  road.lanes = tests::made_section(0, R"(<lane id="1" type="none">
    <width sOffset="0" a="3" b="0" c="0" d="0"/></lane>)",
                                   tests::made_lane(-1));
  const RoadMap map = tests::made_map(tests::made_road(road));
  const auto called_none = [](const Lane& lane) { return to_string(lane.type) == "none"; };
  ASSERT_EQ(lanes_where(called_none, map).size(), 1U);
  EXPECT_EQ(ask("type = none", map), lanes_where(called_none, map));
  EXPECT_EQ(ask("type != none", map), ask("not type = none", map));
  EXPECT_EQ(ask("type in (none, driving)", map).size(), 2U);
  EXPECT_EQ(ask("speed = none", map).size(), 2U);
  EXPECT_TRUE(ask("speed != none", map).empty());
}

TEST(LaneQuestion, ComparesSpeedLimitsAsTheFileSaysThem) {
  for (int kmh = 1; kmh <= 130; ++kmh) {
    tests::MadeRoad road;
    road.type = fmt::format(R"(<type s="0" type="town"><speed max="{}" unit="km/h"/></type>)", kmh);
    const RoadMap map = tests::made_map(tests::made_road(road));
    EXPECT_EQ(ask(fmt::format("speed = {}", kmh), map).size(), 2U) << kmh;
    EXPECT_TRUE(ask(fmt::format("speed > {0} or speed < {0}", kmh), map).empty()) << kmh;
  }
}

TEST(LaneQuestion, AsksAListForEachOfItsTexts) {
  for (const Lane& lane : town().lanes()) {
    Names before;
    for (const LaneId id : town().graph().of(lane.id).predecessors) {
      before.insert(town().lane(id).name);
    }
    EXPECT_EQ(ask("successors = '" + lane.name + "'"), before) << lane.name;
  }
}

TEST(LaneQuestion, AsksForWhatTheSourceSaysUnderAKey) {
  const RoadMap crossing = load_map(tests::data_folder() / "crossing.osm");
  const auto road = [](const Lane& lane) {
    return std::ranges::find(lane.attributes, std::pair<std::string, std::string>(
                                                  "subtype", "road")) != lane.attributes.end();
  };
  EXPECT_EQ(ask("tag.subtype = road", crossing), lanes_where(road, crossing));
  EXPECT_EQ(ask("tag.subtype ~ oa", crossing), lanes_where(road, crossing));
  EXPECT_FALSE(ask("tag.subtype = road", crossing).empty());
  EXPECT_TRUE(ask("tag.no_such_key != 7", crossing).empty());
  EXPECT_EQ(ask("tag.no_such_key = none", crossing).size(), crossing.lanes().size());
}

std::string random_comparison(std::mt19937& random) {
  static const std::vector<std::string> comparisons = {
      "type = driving", "type != 'sidewalk'",     "speed > 45",     "speed <= 50",
      "length>=30",     "junction = none",        "width < 3.4",    "section = 0",
      "lane ~ '/0/'",   "type in (driving, bus)", "one_way = true", "successors = none"};
  return comparisons[random() % comparisons.size()];
}

TEST(LaneQuestion, KeepsTheLawsOfLogic) {
  std::mt19937 random(20261125);
  for (int i = 0; i < 200; ++i) {
    const std::string a = random_comparison(random), b = random_comparison(random),
                      c = random_comparison(random);
    EXPECT_EQ(ask("not (" + a + " and " + b + ")"), ask("not " + a + " or not " + b)) << a << b;
    EXPECT_EQ(ask(a + " or " + b + " and " + c), ask(a + " or (" + b + " and " + c + ")"));
    EXPECT_EQ(ask("not " + a + " and " + b), ask("(not (" + a + ")) and " + b));
    Names both = ask(a), others = ask("not " + a);
    both.merge(others);
    EXPECT_TRUE(others.empty());
    EXPECT_EQ(both.size(), town().lanes().size());
  }
  EXPECT_EQ(ask("type in (driving, sidewalk)"), ask("type = driving or type = sidewalk"));
}

TEST(LaneQuestion, SaysWhereItGoesWrong) {
  EXPECT_EQ(question_fault("type = driving"), "");
  EXPECT_THAT(question_fault("typ = driving"), HasSubstr("at character 1: \"typ\" is no field"));
  EXPECT_THAT(question_fault("speed > fast"), HasSubstr("at character 9: \"fast\" is no number"));
  EXPECT_THAT(question_fault("speed > none"), HasSubstr("\"none\" is no number"));
  EXPECT_THAT(question_fault("type < 3"), HasSubstr("type is a text"));
  EXPECT_THAT(question_fault("speed ~ 3"), HasSubstr("speed is a number"));
  EXPECT_THAT(
      question_fault("type = drving"),
      HasSubstr("at character 8: \"drving\" is nothing that type says; that is one of none, "
                "driving, "));
  EXPECT_THAT(question_fault("participants in (car, horse)"), HasSubstr("\"horse\" is nothing"));
  EXPECT_EQ(question_fault("type ~ amp and one_way != none and tag.type = drving"), "");
  EXPECT_THAT(question_fault("type driving"), HasSubstr("needs = !="));
  EXPECT_THAT(question_fault("type ="), HasSubstr("needs a value, found \"the end\""));
  EXPECT_THAT(question_fault("(lane = a"), HasSubstr("needs \")\", found \"the end\""));
  EXPECT_THAT(question_fault("lane = a b"), HasSubstr("\"b\" is too much"));
  EXPECT_THAT(question_fault("type = 'a"), HasSubstr("a quote that is not closed"));
  EXPECT_THAT(question_fault("lane in (a,)"), HasSubstr("needs a value, found \")\""));
  EXPECT_THAT(question_fault(""), HasSubstr("at character 1: needs a field, found \"the end\""));
  EXPECT_THAT(question_fault(std::string(100'000, '(')), HasSubstr("nested too deeply"));
  std::string nots;
  for (int i = 0; i < 100'000; ++i) nots += "not ";
  EXPECT_THAT(question_fault(nots), HasSubstr("nested too deeply"));
}

}  // namespace
}  // namespace roadbed::map
