// The last cycle of a drive that is left early, against the same cycle of the whole drive.
#include <gtest/gtest.h>

#include <cmath>
#include <cstddef>
#include <string>

#include "roadbed/tests/support/real_data.h"
#include "roadbed/tools/files/trajectory_csv.h"
#include "roadbed/tools/simulation/cycle_log.h"
#include "roadbed/tools/simulation/drive.h"
#include "roadbed/tools/simulation/world.h"

namespace roadbed::tools {
namespace {

/// Keeps what the drive is seen in.
struct OwnDrive {
  explicit OwnDrive(const std::string& name, const LoopOptions& options)
      : scenario(read_scenario(tests::data_folder() / "scenarios" / (name + ".json"))),
        world(make_world(scenario)),
        drive(tools::drive(scenario, world, options)) {}

  Scenario scenario;
  World world;
  Drive drive;
};

class ExplainedCycle : public testing::TestWithParam<const char*> {};

TEST_P(ExplainedCycle, IsTheOneOfTheWholeDriveWithEveryCandidateThatItKeeps) {
  const OwnDrive whole(GetParam(), {.planner = {.keeps_candidates = true}});
  const std::string rows = write_trajectory_csv(whole.drive.trajectory);
  const std::string log = cycle_log(whole.drive);
  const std::size_t cycles = whole.drive.cycles.size();
  const std::size_t stride = planning::KeptCandidates{}.length_stride;
  for (const std::size_t last : {std::size_t{0}, cycles / 4, cycles / 2, cycles - 1}) {
    const OwnDrive left(GetParam(), {.last_cycle = last});
    ASSERT_EQ(left.drive.cycles.size(), last + 1);
    EXPECT_TRUE(log.starts_with(cycle_log(left.drive))) << last;
    EXPECT_TRUE(rows.starts_with(write_trajectory_csv(left.drive.trajectory))) << last;
    ASSERT_TRUE(left.drive.explained);
    const planning::Plan& plan = left.drive.explained->plan;
    const planning::CandidateGrid& grid = *whole.drive.cycles[last].grid;
    const std::size_t width = grid.end_d_m.size();
    const std::size_t lengths = plan.candidates.size() / width;
    EXPECT_EQ(plan.candidates.size(), width * lengths);
    EXPECT_EQ((lengths + stride - 1) / stride, grid.end_l_m.size());
    for (std::size_t i = 0; i < grid.causes.size(); ++i) {
      const planning::Candidate& candidate =
          plan.candidates[i / width * stride * width + i % width];
      EXPECT_EQ(candidate.end_d_m, grid.end_d_m[i % width]);
      EXPECT_EQ(candidate.end_l_m, grid.end_l_m[i / width]);
      EXPECT_EQ(static_cast<std::uint8_t>(candidate.rejection), grid.causes[i])
          << last << ": " << candidate.end_d_m << ", " << candidate.end_l_m;
    }
    const auto& chosen = whole.drive.cycles[last].chosen;
    ASSERT_EQ(plan.chosen.has_value(), chosen.has_value());
    if (chosen) {
      EXPECT_EQ(plan.chosen->cost, chosen->cost);
    }
    const planning::PlanInput& input = left.drive.explained->input;
    const planning::ReferencePoint at = input.line.at(input.start.s_m);
    const Eigen::Vector2d to_left{-std::sin(at.heading_rad), std::cos(at.heading_rad)};
    if (chosen) {
      const Eigen::Vector2d first = plan.trajectory.points().front().pose().position();
      EXPECT_LT((at.in_map + input.start.d_m * to_left - first).norm(), 1e-6) << last;
    }
    EXPECT_EQ(input.start_t_s, whole.drive.cycles[last].t_s);
  }
}

INSTANTIATE_TEST_SUITE_P(OwnScenarios, ExplainedCycle,
                         testing::Values("pass_car", "pass_lorry", "overtake", "narrowing",
                                         "narrow_gap", "stop_and_go", "lane_change"),
                         [](const auto& scenario) { return std::string(scenario.param); });

TEST(ExplainedCycle, IsLeftOutOfADriveThatEndsBefore) {
  const OwnDrive whole("narrowing", {.last_cycle = 100'000});
  EXPECT_EQ(whole.drive.verdict.outcome, Outcome::goal_reached);
  EXPECT_FALSE(whole.drive.explained);
}

TEST(CycleLog, SaysOfEveryCycleWhatIsDrivenAndWhyNothingElse) {
  for (const char* name : {"overtake", "pass_lorry", "on_ramp"}) {
    const OwnDrive whole(name, {});
    std::size_t lost = 0;
    for (const DriveCycle& cycle : whole.drive.cycles) {
      std::size_t driven = 0;
      for (const planning::HypothesisOutcome& one : cycle.hypotheses) {
        driven += one.is_driven ? 1 : 0;
        lost += one.is_driven ? 0 : 1;
        EXPECT_NE(one.is_driven, !one.reason.empty()) << name << " " << cycle.t_s;
        if (!one.is_driven || !cycle.chosen) continue;
        EXPECT_EQ(one.end_d_m, cycle.chosen->end_d_m) << name << " " << cycle.t_s;
      }
      EXPECT_EQ(driven, 1U) << name << " " << cycle.t_s;
    }
    EXPECT_GT(lost, 10U) << name;
  }
}

}  // namespace
}  // namespace roadbed::tools
