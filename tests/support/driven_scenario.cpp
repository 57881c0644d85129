#include "roadbed/tests/support/driven_scenario.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <utility>

#include "roadbed/tests/support/real_data.h"

namespace roadbed::tests {

using tools::DriveCycle;
using tools::DriveSample;

double DrivenScenario::clearance_m() const {
  return std::ranges::min(drive.samples, {}, &DriveSample::clearance_m).clearance_m;
}

double DrivenScenario::off_road_m() const {
  return std::ranges::max(drive.samples, {}, &DriveSample::off_road_m).off_road_m;
}

const DriveCycle* DrivenScenario::first(planning::Behaviour behaviour,
                                        const std::string& text) const {
  const auto found = std::ranges::find_if(drive.cycles, [&](const DriveCycle& cycle) {
    return cycle.behaviour == behaviour && cycle.reason.find(text) != std::string::npos;
  });
  return found == drive.cycles.end() ? nullptr : &*found;
}

double DrivenScenario::passes_x_at_s(double x_m) const {
  for (const auto& row : drive.trajectory.points()) {
    if (row.x_m + geometry::VehicleShape{}.front_m() >= x_m) return row.t_s;
  }
  return 1e9;
}

tools::Scenario scenario_of(const std::string& name) {
  return tools::read_scenario(data_folder() / "scenarios" / (name + ".json"));
}

DrivenScenario driven(const tools::Scenario& scenario, const tools::LoopOptions& options) {
  tools::World world = tools::make_world(scenario);
  tools::Drive drive = tools::drive(scenario, world, options);
  return {std::move(world), std::move(drive)};
}

void expect_arrives(const DrivenScenario& driven, double clearance_m) {
  EXPECT_EQ(driven.drive.verdict.outcome, tools::Outcome::goal_reached)
      << driven.drive.verdict.text;
  EXPECT_GE(driven.clearance_m(), clearance_m);
  EXPECT_EQ(driven.off_road_m(), 0.0);
  EXPECT_EQ(driven.first(planning::Behaviour::emergency), nullptr);
}

}  // namespace roadbed::tests
