#pragma once

#include <string>

#include "roadbed/tools/simulation/drive.h"

namespace roadbed::tests {

/// A scenario's world, and the drive through it.
struct DrivenScenario {
  tools::World world;
  tools::Drive drive;

  double clearance_m() const;  ///< least, to others
  double off_road_m() const;   ///< most
  double speed_at(double t_s) const { return drive.trajectory.at(t_s).speed_mps; }

  /// First cycle of a behaviour whose reason holds a text; null if there is none.
  const tools::DriveCycle* first(planning::Behaviour behaviour, const std::string& text = "") const;

  /// Time at which the front bumper passes x on the way east; huge if it never does.
  double passes_x_at_s(double x_m) const;
};

/// Of data/scenarios.
tools::Scenario scenario_of(const std::string& name);

DrivenScenario driven(const tools::Scenario& scenario, const tools::LoopOptions& options = {});
inline DrivenScenario driven(const std::string& name) { return driven(scenario_of(name)); }

/// At the goal, on the road, this far from others, and never in an emergency.
void expect_arrives(const DrivenScenario& driven, double clearance_m);

}  // namespace roadbed::tests
