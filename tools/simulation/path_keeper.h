#pragma once

#include <optional>

#include "roadbed/planning/plan.h"
#include "roadbed/tools/simulation/planned_path.h"
#include "roadbed/tools/simulation/scenario.h"
#include "roadbed/tools/simulation/sensors.h"
#include "roadbed/tools/simulation/world.h"

namespace roadbed::tools {

/// The path that is being driven, from cycle to cycle: plans on from the last plan while the
/// vehicle follows it well enough, and keeps the last path when nothing is feasible.
class PathKeeper {
 public:
  struct Bounds {
    double tracking_error_m;
    double heading_error_rad;
  };

  PathKeeper(const Scenario& scenario, const World& world, const Bounds& bounds);

  /// Plans from where the vehicle is measured to be.
  /// @param target_mps  the set speed of the last cycle.
  void plan(double t_s, const VehicleState& measured, double target_mps);

  /// Of the last cycle; `chosen` is empty if nothing was feasible.
  const planning::Plan& last_plan() const { return plan_; }
  bool from_measurement() const { return from_measurement_; }

  /// How far the body was allowed past the corridor's edge, because nothing keeps to it [m].
  double beyond_the_edge_m() const { return beyond_the_edge_m_; }

  /// Station of the measured rear axle at the last cycle.
  double s_m() const { return s_m_; }

  /// How far the kept path was found feasible when it was planned, from the vehicle on.
  double checked_ahead_m() const { return checked_to_s_m_ - s_m_; }

  /// Whether the last cycle rejected candidates because they would touch something.
  bool something_is_in_the_way() const;

  /// The path to drive.
  const PlannedPath& path() const { return *path_; }

  /// The same, led back to the reference line beyond the plan's end: where the vehicle is expected
  /// to drive later on.
  PlannedPath expected_path() const;

 private:
  planning::LateralState start_state(const VehicleState& measured);

  const Scenario& scenario_;
  const World& world_;
  Bounds bounds_;
  planning::LineView line_;
  planning::Plan plan_;
  std::optional<PlannedPath> path_;
  double path_end_s_m_ = 0.0;
  double checked_to_s_m_ = 0.0;
  double s_m_ = 0.0;
  double beyond_the_edge_m_ = 0.0;
  bool from_measurement_ = false;
};

}  // namespace roadbed::tools
