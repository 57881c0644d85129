#include "roadbed/tools/simulation/pilot_lines.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <memory>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "roadbed/map/files/json_text.h"
#include "roadbed/map/load_map.h"
#include "roadbed/tests/support/real_data.h"
#include "roadbed/tests/support/refusal_of.h"
#include "roadbed/tools/simulation/drive.h"
#include "roadbed/tools/simulation/outside_planner.h"

namespace roadbed::tools {
namespace {

using testing::HasSubstr;

std::shared_ptr<const map::RoadMap> town() {
  static const auto road_map =
      std::make_shared<map::RoadMap>(map::load_map(tests::data_folder() / "town.xodr"));
  return road_map;
}

planning::PilotSetup setup() {
  return {.road_map = town(), .goal = {*town()->find_lane("6/0/-1"), 100.0}};
}

std::string fault_of(const std::string& line) {
  return tests::refusal_of([&] { parse_pilot_view(*town(), line, "line 1"); });
}

constexpr const char* kEgo =
    R"("ego":{"x_m":10,"y_m":20,"heading_rad":0.1,"speed_mps":3,"acceleration_mps2":-1})";

TEST(PilotLines, AreReadAsTheyAreWritten) {
  const std::string signal = town()->signals().front().source_id;
  const planning::PilotView view = parse_pilot_view(
      *town(),
      fmt::format(R"({{"t_s":1.5,{},"obstacles":[{{"id":"a","kind":"bus","x_m":1,"y_m":2,)"
                  R"("heading_rad":3,"speed_mps":4,"length_m":12,"width_m":2.5}},)"
                  R"({{"x_m":5,"y_m":6,"heading_rad":0,"speed_mps":-1}}],)"
                  R"("lights":[{{"signal":"{}","colour":"yellow"}}],"scene":{{"any":1}}}})",
                  kEgo, signal),
      "line 1");
  EXPECT_EQ(view.t_s, 1.5);
  EXPECT_EQ(view.ego.speed_mps, 3.0);
  EXPECT_EQ(view.ego.acceleration_mps2, -1.0);
  EXPECT_EQ(town()->to_source(view.ego.map_from_vehicle.position()), Eigen::Vector2d(10, 20));
  EXPECT_TRUE(view.has_objects);
  ASSERT_EQ(view.objects.size(), 2u);
  EXPECT_EQ(view.objects[0].kind, "bus");
  EXPECT_EQ(view.objects[0].length_m, 12.0);
  EXPECT_EQ(view.objects[0].centre.heading_rad, 3.0);
  EXPECT_EQ(view.objects[1].id, "");
  EXPECT_EQ(view.objects[1].speed_mps, -1.0);
  ASSERT_EQ(view.lights.size(), 1u);
  EXPECT_EQ(view.lights[0].colour, planning::LightColour::yellow);
}

TEST(PilotLines, WithoutObstaclesSayThatNobodyLooked) {
  const auto view_of = [](const std::string& rest) {
    return parse_pilot_view(
        *town(),
        R"({"t_s":0,"ego":{"x_m":0,"y_m":0,"heading_rad":0,"speed_mps":-0.02})" + rest + "}",
        "line 1");
  };
  EXPECT_FALSE(view_of("").has_objects);
  EXPECT_TRUE(view_of(R"(,"obstacles":[])").has_objects);
  EXPECT_EQ(view_of("").ego.speed_mps, 0.0);  // who rolls back a little stands
}

TEST(PilotLines, AreRefusedWithTheirPlace) {
  const auto with = [](const std::string& rest) {
    return fmt::format(R"({{"t_s":0,{},{}}})", kEgo, rest);
  };
  EXPECT_THAT(fault_of("{"), HasSubstr("line 1:"));
  EXPECT_THAT(fault_of("{}"), HasSubstr("t_s"));
  EXPECT_THAT(fault_of(R"({"t_s":0})"), HasSubstr("ego"));
  EXPECT_THAT(fault_of(with(R"("obstacle":[])")), HasSubstr("obstacle"));
  EXPECT_THAT(fault_of(with(R"("obstacles":[{"x_m":1,"y_m":2,"heading_rad":0}])")),
              HasSubstr("/obstacles/0"));
  EXPECT_THAT(
      fault_of(with(R"("obstacles":[{"x_m":1e300,"y_m":2,"heading_rad":0,"speed_mps":0}])")),
      HasSubstr("/obstacles/0/x_m"));
  EXPECT_THAT(
      fault_of(with(R"("obstacles":[{"id":"a","x_m":1,"y_m":2,"heading_rad":0,"speed_mps":0},)"
                    R"({"id":"a","x_m":1,"y_m":2,"heading_rad":0,"speed_mps":0}])")),
      HasSubstr("/obstacles/1/id: is \"a\" again"));
  EXPECT_THAT(fault_of(with(R"("lights":[{"signal":"nowhere","colour":"red"}])")),
              HasSubstr("/lights/0/signal"));
  EXPECT_THAT(fault_of(R"({"t_s":0,"ego":{"x_m":0,"y_m":0,"heading_rad":0,"speed_mps":-1.5}})"),
              HasSubstr("/ego/speed_mps"));
}

/// Answers to lines of text.
std::vector<nlohmann::json> answers(const std::string& lines,
                                    const PilotLineOptions& options = {}) {
  planning::Pilot pilot(setup());
  std::istringstream in(lines);
  std::ostringstream out;
  answer_lines(pilot, *town(), in, out, options);
  std::vector<nlohmann::json> found;
  std::istringstream read(out.str());
  for (std::string line; std::getline(read, line);) found.push_back(nlohmann::json::parse(line));
  return found;
}

std::string ego_line(double t_s) {
  const geometry::Pose2 pose = town()->lane(*town()->find_lane("31/0/-2")).pose_at(20.0);
  const Eigen::Vector2d place = town()->to_source(pose.position());
  return fmt::format(R"({{"t_s":{},"ego":{{"x_m":{},"y_m":{},"heading_rad":{},"speed_mps":0}}}})"
                     "\n",
                     t_s, place.x(), place.y(), pose.heading_rad);
}

TEST(PilotLines, EachHasItsAnswerWhateverItIs) {
  const auto found = answers(ego_line(0.0) + "no json\n\n" + ego_line(0.0) + ego_line(0.1) +
                                 std::string(3000, 'x') + "\n" + ego_line(0.2),
                             {.most_bytes = 2000});
  ASSERT_EQ(found.size(), 7u);
  for (const std::size_t good : {0, 4, 6}) {
    EXPECT_FALSE(found[good].contains("error"));
    EXPECT_EQ(found[good]["trajectory"].back()[4], 0.0);
    EXPECT_FALSE(found[good]["reason"].get<std::string>().empty());
  }
  EXPECT_THAT(found[1]["error"].get<std::string>(), HasSubstr("line 2"));
  EXPECT_TRUE(found[1]["trajectory"].is_null());
  EXPECT_THAT(found[3]["error"].get<std::string>(), HasSubstr("line 4:/t_s: 0 s after 0 s"));
  EXPECT_THAT(found[5]["error"].get<std::string>(), HasSubstr("more than 2000 bytes"));
}

TEST(PilotLines, TellWhatIsBelievedOfObjects) {
  std::string lines;
  for (int k = 0; k < 10; ++k) {
    const geometry::Pose2 pose = town()->lane(*town()->find_lane("31/0/-1")).pose_at(40.0 + k);
    const Eigen::Vector2d place = town()->to_source(pose.position());
    std::string line = ego_line(0.1 * k);
    line.insert(
        line.size() - 2,
        fmt::format(R"(,"obstacles":[{{"x_m":{},"y_m":{},"heading_rad":{},"speed_mps":10}}])",
                    place.x(), place.y(), pose.heading_rad));
    lines += line;
  }
  const auto found = answers(lines, {.tells_objects = true});
  ASSERT_EQ(found.size(), 10u);
  ASSERT_EQ(found.back()["tracks"].size(), 1u);
  const nlohmann::json& track = found.back()["tracks"][0];
  EXPECT_EQ(track["id"], "track 1");
  EXPECT_NEAR(track["speed_mps"].get<double>(), 10.0, 0.05);
  EXPECT_LT(track["position_deviation_m"].get<double>(), 0.1);
  EXPECT_EQ(track["motions"][0]["lanes"][0], "31/0/-1");
}

/// What simulate asks another planner, asked of a pilot in the same words.
Drive driven_by_pilot(const std::string& name) {
  const Scenario scenario = read_scenario(tests::data_folder() / "scenarios" / (name + ".json"));
  World world = make_world(scenario);
  const planning::RouteLeg& last = world.route.legs.back();
  planning::Pilot pilot({.road_map = world.kept_map,
                         .goal = {last.lane, last.to_s_m},
                         .vehicle = scenario.vehicle,
                         .driving = scenario.options,
                         .occupied = world.field});
  const OutsidePlanner asks = [&](const Observation& seen) {
    const std::string line = map::json_text(observation_json(seen, false));
    const planning::PilotView view = parse_pilot_view(world.road_map, line, "line");
    return parse_outside_plan(pilot_answer_line(world.road_map, view.t_s, pilot.step(view)), "it");
  };
  return tools::drive(scenario, world, {.outside_planner = asks});
}

class PilotDrives : public testing::TestWithParam<const char*> {};

TEST_P(PilotDrives, ReachTheGoalThroughTheProtocol) {
  const Drive drive = driven_by_pilot(GetParam());
  EXPECT_EQ(drive.verdict.outcome, Outcome::goal_reached) << drive.verdict.text;
  double clearance_m = 1e9, off_road_m = 0.0;
  for (const DriveSample& sample : drive.samples) {
    clearance_m = std::min(clearance_m, sample.clearance_m);
    off_road_m = std::max(off_road_m, sample.off_road_m);
  }
  EXPECT_GT(clearance_m, 0.1);
  EXPECT_LT(off_road_m, 0.05);
}

INSTANTIATE_TEST_SUITE_P(Scenarios, PilotDrives,
                         testing::Values("cut_in", "lane_change", "left_turn", "narrow_gap",
                                         "narrowing", "on_ramp", "overtake", "parked_car",
                                         "pass_car", "pass_lorry", "pedestrian", "ramp",
                                         "red_light", "roundabout", "slower_lead", "stop_and_go",
                                         "stop_sign", "zip", "closed_road"),
                         [](const auto& name) { return std::string(name.param); });

}  // namespace
}  // namespace roadbed::tools
