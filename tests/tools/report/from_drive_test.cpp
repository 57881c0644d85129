#include "roadbed/tools/report/from_drive.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "roadbed/tests/support/real_data.h"
#include "roadbed/tools/report/page_parts.h"
#include "roadbed/tools/report/report.h"

namespace roadbed::tools {
namespace {

DriveCycle cycle_at(double t_s, planning::Behaviour behaviour, const std::string& reason) {
  DriveCycle cycle;
  cycle.t_s = t_s;
  cycle.behaviour = behaviour;
  cycle.reason = reason;
  return cycle;
}

// Half a second along the x axis.
Drive short_drive() {
  Drive drive;
  std::vector<geometry::TrajectoryPoint> points;
  for (int i = 0; i <= 5; ++i) {
    points.push_back({.t_s = 0.1 * i, .x_m = 60.0 + i, .y_m = 196.7, .speed_mps = 10.0});
    drive.samples.push_back({.t_s = 0.1 * i, .speed_limit_mps = 13.0, .clearance_m = 2.0});
  }
  drive.trajectory = geometry::Trajectory(points);
  drive.cycles = {cycle_at(0.0, planning::Behaviour::cruise, "free"),
                  cycle_at(0.1, planning::Behaviour::cruise, "free"),
                  cycle_at(0.2, planning::Behaviour::follow, "car a"),
                  cycle_at(0.3, planning::Behaviour::follow, "car b"),
                  cycle_at(0.4, planning::Behaviour::cruise, "free again")};
  drive.cycles[1].chosen = planning::Candidate{.end_d_m = -0.42, .end_l_m = 22.0};
  drive.cycles[1].path = {{61.0, 196.7}, {80.0, 196.3}};
  drive.cycles[2].plan_reason = "all collide";
  drive.events = {{0.3, EventLevel::warning, "close"}};
  drive.verdict = {Outcome::goal_reached, 0.5, "goal reached after 0.5 s"};
  return drive;
}

const World& world() {
  static const World made =
      make_world(read_scenario(tests::data_folder() / "scenarios/parked_car.json"));
  return made;
}

ReportInput reported(const Drive& drive, const ReportContext& context = {}) {
  const auto scenario = read_scenario(tests::data_folder() / "scenarios/parked_car.json");
  return report_of(scenario, world(), drive, context);
}

TEST(DecisionsOf, AreRunsOfEqualBehaviourThatLeaveNoGap) {
  const auto decisions = decisions_of(short_drive());
  ASSERT_EQ(decisions.size(), 3U);
  EXPECT_EQ(decisions[0].state, "cruise");
  EXPECT_EQ(decisions[1].state, "follow");
  EXPECT_EQ(decisions[1].reason, "car a");
  EXPECT_EQ(decisions[2].reason, "free again");
  EXPECT_EQ(decisions[0].to_s, decisions[1].from_s);
  EXPECT_EQ(decisions[1].to_s, decisions[2].from_s);
  EXPECT_EQ(decisions[2].to_s, 0.5);  // the drive's end
}

TEST(DecisionsOf, NothingAreNone) { EXPECT_TRUE(decisions_of({}).empty()); }

TEST(ReportOf, SaysWhatEachCycleChose) {
  const auto plans = nlohmann::json::parse(page_data_json(reported(short_drive())))["plans"];
  ASSERT_EQ(plans.size(), 5U);
  EXPECT_EQ(plans[1]["note"], "ends 0.4 m to the right after 22.0 m");
  EXPECT_EQ(plans[1]["path"].size(), 4U);
  EXPECT_EQ(plans[3]["reason"], "car b");
  EXPECT_EQ(plans[0]["note"], "none feasible");
  EXPECT_EQ(plans[2]["note"], "all collide");
}

TEST(ReportOf, ShowsObstaclesAndGoalInSourceCoordinates) {
  const ReportInput input = reported(short_drive());
  ASSERT_EQ(input.scene.obstacles.size(), world().obstacles.size());
  const Eigen::Vector2d in_map = world().obstacles[0].motion.points()[0].pose().position();
  const Eigen::Vector2d shown = input.scene.obstacles[0].motion.points()[0].pose().position();
  EXPECT_NEAR((shown - world().road_map.to_source(in_map)).norm(), 0.0, 1e-9);
  ASSERT_TRUE(input.scene.goal);
  EXPECT_NEAR((*input.scene.goal - input.scene.route.back().back()).norm(), 0.0, 1e-9);
  EXPECT_GT(input.scene.road_map->lanes().size(), 0U);
}

TEST(ReportOf, SortsConflictsAmongTheEvents) {
  ReportContext context;
  context.audit.emplace();
  context.audit->verdict = planning::Verdict::conflict;
  context.audit->conflicts.push_back(
      {.from_s = 0.1, .to_s = 0.2, .at = {}, .witness = {{0, 0}, {1, 1}}});
  const ReportInput input = reported(short_drive(), context);
  ASSERT_EQ(input.drive.events.size(), 2U);
  EXPECT_EQ(input.drive.events[0].level, EventLevel::fault);
  EXPECT_EQ(input.drive.events[1].text, "close");
  EXPECT_EQ(input.audit->tone, Tone::bad);
  EXPECT_EQ(input.verdict.tone, Tone::good);
}

TEST(ReportOf, TakesAnAuditThatFoundTooMuchUnknownAsOpen) {
  ReportContext context;
  context.audit.emplace();
  context.audit->verdict = planning::Verdict::unknown;
  context.audit->unknown_fraction = 0.48;
  const ReportInput input = reported(short_drive(), context);
  EXPECT_EQ(input.audit->tone, Tone::open);
  EXPECT_NE(input.audit->text.find("48 % of the swept area was never measured"), std::string::npos);
}

TEST(ReportOf, ADriveWithoutARowStillMakesAPage) {
  EXPECT_NO_THROW(drive_report_html(reported({})));
}

}  // namespace
}  // namespace roadbed::tools
