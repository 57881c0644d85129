#include "roadbed/tools/simulation/scenario.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <string>

#include "roadbed/tests/support/refusal_of.h"

namespace roadbed::tools {
namespace {

using nlohmann::json;

json full() {
  return json::parse(R"({
    "roadbed_scenario": 1, "name": "test", "map": "town.xodr", "occupancy": ["a.pcd", "/b.ply"],
    "ego": {"start": "1,2,90", "speed_mps": 8.5}, "goal": "lane:7/0/-1@80",
    "vehicle": {"length_m": 5.0}, "duration_s": 30, "seed": 7,
    "noise": {"gap_m": 0.5}, "options": {"desired_speed_mps": 10},
    "obstacles": [
      {"id": "p", "parked": {"x_m": 1.0, "y_m": 2.0, "heading_rad": 0.5}},
      {"id": "q", "parked": {"place": "lane:1@60", "d_m": -1.2}},
      {"id": "s", "kind": "pedestrian", "length_m": 0.5, "width_m": 0.4,
       "scripted": [{"t_s": 0, "x_m": 0, "y_m": 0, "heading_rad": 0},
                    {"t_s": 5, "x_m": 5, "y_m": 0, "heading_rad": 0}]},
      {"id": "t", "traffic": {"start": "lane:1", "to": "lane:9", "speed_mps": 6}},
      {"id": "u", "traffic": {"start": "lane:2",
       "speeds": [{"t_s": 0, "speed_mps": 6}, {"t_s": 9, "speed_mps": 0}]}}]})");
}

Scenario parsed(const json& document) { return parse_scenario(document.dump(), "maps/test.json"); }

std::string message_of(const std::string& text) {
  return tests::refusal_of([&] { parse_scenario(text, "test.json"); });
}

/// What the reader says when one value of the full scenario is replaced.
std::string message_with(const std::string& pointer, const json& value) {
  json document = full();
  document[json::json_pointer(pointer)] = value;
  return message_of(document.dump());
}

std::string message_without(const std::string& parent, const std::string& key) {
  json document = full();
  document[json::json_pointer(parent)].erase(key);
  return message_of(document.dump());
}

TEST(Scenario, EveryPartIsRead) {
  const Scenario scenario = parsed(full());
  EXPECT_EQ(scenario.name, "test");
  EXPECT_EQ(scenario.map_file, "maps/town.xodr");
  EXPECT_THAT(scenario.occupancy_files, testing::ElementsAre("maps/a.pcd", "/b.ply"));
  EXPECT_EQ(scenario.start.text, "1,2,90");
  EXPECT_EQ(scenario.start.pointer, "/ego/start");
  EXPECT_EQ(scenario.start_speed_mps, 8.5);
  EXPECT_EQ(scenario.goal.text, "lane:7/0/-1@80");
  EXPECT_EQ(scenario.vehicle.length_m, 5.0);
  EXPECT_EQ(scenario.vehicle.width_m, geometry::VehicleShape{}.width_m);
  EXPECT_EQ(scenario.duration_s, 30.0);
  EXPECT_EQ(scenario.seed, 7U);
  EXPECT_EQ(scenario.noise.gap_m, 0.5);
  EXPECT_EQ(scenario.noise.position_m, 0.0);
  EXPECT_EQ(scenario.options.desired_speed_mps, 10.0);
  EXPECT_EQ(scenario.options.clearance_m, 0.3);
}

TEST(Scenario, EveryKindOfObstacleIsRead) {
  const Scenario scenario = parsed(full());
  ASSERT_EQ(scenario.obstacles.size(), 5U);
  const auto& pose =
      std::get<geometry::Pose2>(std::get<ParkedObstacle>(scenario.obstacles[0].motion).at);
  EXPECT_EQ(pose.y_m, 2.0);
  EXPECT_EQ(scenario.obstacles[0].length_m, 4.5);
  const auto& beside =
      std::get<ParkedObstacle::Beside>(std::get<ParkedObstacle>(scenario.obstacles[1].motion).at);
  EXPECT_EQ(beside.place.text, "lane:1@60");
  EXPECT_EQ(beside.d_m, -1.2);
  const auto& poses = std::get<ScriptedObstacle>(scenario.obstacles[2].motion).poses;
  EXPECT_EQ(poses[1].t_s, 5.0);
  EXPECT_EQ(poses[1].pose.x_m, 5.0);
  EXPECT_EQ(scenario.obstacles[2].kind, "pedestrian");
  const auto& constant = std::get<TrafficObstacle>(scenario.obstacles[3].motion);
  EXPECT_EQ(constant.to->pointer, "/obstacles/3/traffic/to");
  EXPECT_EQ(constant.speeds[0].speed_mps, 6.0);
  const auto& profile = std::get<TrafficObstacle>(scenario.obstacles[4].motion);
  EXPECT_FALSE(profile.to);
  EXPECT_EQ(profile.speeds[1].t_s, 9.0);
}

json with_way_points() {
  json document = full();
  document.erase("goal");
  document["way_points"] = {"3,4", "lane:7/0/-1@80"};
  return document;
}

TEST(Scenario, WayPointsStandInPlaceOfTheGoal) {
  json document = with_way_points();
  const Scenario plain = parsed(document);
  ASSERT_EQ(plain.way_points->places.size(), 2U);
  EXPECT_EQ(plain.way_points->places[1].text, "lane:7/0/-1@80");
  EXPECT_EQ(plain.way_points->places[1].pointer, "/way_points/1");
  EXPECT_EQ(plain.way_points->half_width_m, 1.75);
  EXPECT_EQ(plain.way_points->speed_limit_mps, 50.0 / 3.6);
  document["half_width_m"] = 3.0;
  document["speed_limit_mps"] = 9.0;
  EXPECT_EQ(parsed(document).way_points->half_width_m, 3.0);
  EXPECT_EQ(parsed(document).way_points->speed_limit_mps, 9.0);
  EXPECT_FALSE(parsed(full()).way_points);
}

TEST(Scenario, JustOneOfGoalAndWayPointsIsTaken) {
  json document = with_way_points();
  document["goal"] = "9,9";
  EXPECT_EQ(message_of(document.dump()),
            "test.json:/way_points: stands beside goal, needs one of the two; remove one");
  EXPECT_THAT(message_without("", "goal"), testing::HasSubstr("goal"));
  EXPECT_THAT(message_with("/half_width_m", 2.0),
              testing::StartsWith("test.json:/half_width_m: stands without way_points"));
  document = with_way_points();
  document["lights"] = json::array();
  EXPECT_THAT(message_of(document.dump()),
              testing::StartsWith("test.json:/lights: stands beside way_points"));
  document = with_way_points();
  document["way_points"] = json::array();
  EXPECT_THAT(message_of(document.dump()),
              testing::StartsWith("test.json:/way_points: is an empty list"));
}

TEST(Scenario, WhatIsOptionalMayBeMissing) {
  const Scenario scenario = parse_scenario(
      R"({"roadbed_scenario": 1, "map": "m.xodr", "ego": {"start": "0,0"}, "goal": "9,9",
          "duration_s": 5})",
      "folder/short.json");
  EXPECT_EQ(scenario.name, "short");
  EXPECT_EQ(scenario.start_speed_mps, 0.0);
  EXPECT_EQ(scenario.seed, 1U);
  EXPECT_TRUE(scenario.obstacles.empty());
  EXPECT_TRUE(scenario.occupancy_files.empty());
  EXPECT_TRUE(scenario.pedals);
}

TEST(Scenario, PedalsAreUsedUnlessTheFileSaysOtherwise) {
  json document = full();
  EXPECT_TRUE(parsed(document).pedals);
  document["options"]["pedals"] = false;
  EXPECT_FALSE(parsed(document).pedals);
  document["options"]["pedals"] = 0;
  EXPECT_THAT(message_of(document.dump()), testing::HasSubstr("/options/pedals"));
}

TEST(Scenario, FaultsAreReportedAtTheirPlace) {
  using testing::StartsWith;
  EXPECT_THAT(message_with("/obstacles/1/length_m", -4),
              StartsWith("test.json:/obstacles/1/length_m: is -4"));
  EXPECT_THAT(message_with("/obstacles/1/length_m", 0),
              StartsWith("test.json:/obstacles/1/length_m: is 0"));
  EXPECT_THAT(message_with("/obstacles/0/parked/x_m", "1"),
              StartsWith("test.json:/obstacles/0/parked/x_m: is string"));
  EXPECT_THAT(message_with("/obstacles/0/parked/x_m", nullptr),
              StartsWith("test.json:/obstacles/0/parked/x_m: is null"));
  EXPECT_THAT(message_with("/obstacles/2/scripted/1/t_s", 0),
              StartsWith("test.json:/obstacles/2/scripted/1/t_s: is 0 after 0"));
  EXPECT_THAT(message_with("/obstacles/2/scripted/1/t_s", 5e-324),
              StartsWith("test.json:/obstacles/2/scripted/1/t_s: is 5e-324 after 0"));
  EXPECT_THAT(message_with("/obstacles/4/traffic/speeds/1/t_s", -1),
              StartsWith("test.json:/obstacles/4/traffic/speeds/1/t_s: is -1"));
  EXPECT_THAT(message_with("/obstacles/4/traffic/speed_mps", 1),
              StartsWith("test.json:/obstacles/4/traffic/speeds: stands beside speed_mps"));
  EXPECT_THAT(message_with("/obstacles/1/id", "p"),
              StartsWith("test.json:/obstacles/1/id: is \"p\" again, as /obstacles/0"));
  EXPECT_THAT(message_with("/obstacles/1/parked/x_m", 1),
              StartsWith("test.json:/obstacles/1/parked/x_m: is not a known key"));
  EXPECT_THAT(message_with("/obstacles/1/scripted", json::array()),
              StartsWith("test.json:/obstacles/1: does not say how it moves"));
  EXPECT_THAT(message_without("/obstacles/1", "parked"),
              StartsWith("test.json:/obstacles/1: does not say how it moves"));
  EXPECT_THAT(message_with("/obstacles/2/scripted", json::array()),
              StartsWith("test.json:/obstacles/2/scripted: is an empty list"));
  EXPECT_THAT(message_with("/obstacles", 3), StartsWith("test.json:/obstacles: is number"));
  EXPECT_THAT(message_with("/speed", 3), StartsWith("test.json:/speed: is not a known key"));
  EXPECT_THAT(message_with("/a~1b", 3), StartsWith("test.json:/a~1b: is not a known key"));
  EXPECT_THAT(message_with("/duration_s", 0), StartsWith("test.json:/duration_s: is 0"));
  EXPECT_THAT(message_with("/seed", 1.5), StartsWith("test.json:/seed: is 1.5"));
  EXPECT_THAT(message_with("/vehicle/wheelbase_m", -1),
              StartsWith("test.json:/vehicle/wheelbase_m: is -1"));
  EXPECT_THAT(message_with("/roadbed_scenario", 2),
              StartsWith("test.json:/roadbed_scenario: is 2"));
  EXPECT_THAT(message_with("/goal", ""), StartsWith("test.json:/goal: is empty"));
  EXPECT_THAT(message_with("/occupancy", json::array()),
              StartsWith("test.json:/occupancy: is an empty list"));
  EXPECT_THAT(message_with("/noise/gap_m", -1), StartsWith("test.json:/noise/gap_m: is -1"));
  EXPECT_THAT(message_with("/options/weights", 1),
              StartsWith("test.json:/options/weights: is not a known key"));
  EXPECT_THAT(message_without("", "map"), StartsWith("test.json:/: has no key \"map\""));
  EXPECT_THAT(message_without("/ego", "start"), StartsWith("test.json:/ego: has no key \"start\""));
}

TEST(Scenario, LightsAndDropoutsAreReadAndChecked) {
  json document = full();
  document["lights"] = json::parse(
      R"([{"signals": ["1", "2"], "offset_s": -3,
           "phases": [{"colour": "green", "duration_s": 8}, {"colour": "red", "duration_s": 12}]}])");
  document["noise"]["dropouts"] = json::parse(R"([{"from_s": 2, "to_s": 2.5}])");
  document["noise"]["dropout_share"] = 0.1;
  const Scenario scenario = parsed(document);
  ASSERT_EQ(scenario.lights.size(), 1U);
  EXPECT_EQ(scenario.lights[0].signals, (std::vector<std::string>{"1", "2"}));
  EXPECT_EQ(colour_at(scenario.lights[0], 4.9), planning::LightColour::green);
  EXPECT_EQ(colour_at(scenario.lights[0], 5.1), planning::LightColour::red);
  EXPECT_EQ(colour_at(scenario.lights[0], 17.1), planning::LightColour::green);
  EXPECT_EQ(scenario.noise.dropouts[0].to_s, 2.5);
  EXPECT_EQ(scenario.noise.dropout_ratio, 0.1);
  const auto message = [&](const std::string& pointer, const json& value) {
    json broken = document;
    broken[json::json_pointer(pointer)] = value;
    return message_of(broken.dump());
  };
  using testing::StartsWith;
  EXPECT_THAT(message("/lights/0/phases/0/colour", "blue"),
              StartsWith("test.json:/lights/0/phases/0/colour: is \"blue\""));
  EXPECT_THAT(message("/lights/0/phases/1/duration_s", 0),
              StartsWith("test.json:/lights/0/phases/1/duration_s: is 0"));
  EXPECT_THAT(message("/lights/0/phases", json::array()),
              StartsWith("test.json:/lights/0/phases: is an empty list"));
  EXPECT_THAT(message("/noise/dropouts/0/to_s", 1), StartsWith("test.json:/noise/dropouts/0/to_s"));
  EXPECT_THAT(message("/noise/dropout_share", 2),
              StartsWith("test.json:/noise/dropout_share: is 2"));
}

TEST(Scenario, TextThatIsNotJsonIsRefusedWithItsByte) {
  EXPECT_THAT(message_of("{\"roadbed_scenario\": 1,}"),
              testing::StartsWith("test.json:byte 24: is not JSON"));
  EXPECT_THAT(message_of("{\"duration_s\": NaN}"), testing::HasSubstr("is not JSON"));
  EXPECT_THAT(message_of("{\"duration_s\": 1e999}"), testing::HasSubstr("too large"));
  EXPECT_THAT(message_of("[]"), testing::HasSubstr("is array, needs an object"));
  EXPECT_THAT(message_of(std::string(100'000, '[')), testing::HasSubstr("is not JSON"));
}

TEST(Scenario, AKeyThatStandsTwiceIsRefused) {
  EXPECT_THAT(message_of(R"({"map": "a.xodr", "map": "b.xodr"})"),
              testing::HasSubstr("key \"map\": stands twice"));
}

TEST(Scenario, EveryCutOfAScenarioIsRefused) {
  const std::string text = full().dump();
  for (std::size_t length = 0; length < text.size(); ++length) {
    EXPECT_NE(message_of(text.substr(0, length)), "accepted") << length;
  }
}

}  // namespace
}  // namespace roadbed::tools
