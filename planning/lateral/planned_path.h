#pragma once

#include <functional>

#include "roadbed/geometry/primitives/pose2.h"
#include "roadbed/planning/lateral/plan_types.h"
#include "roadbed/planning/reference/reference_line.h"

namespace roadbed::planning::inline lateral {

/// State of the own vehicle, true or measured; the pose is that of its rear axle.
struct VehicleState {
  geometry::Pose2 map_from_vehicle{};
  double speed_mps = 0.0;
  double steering_rad = 0.0;
  double acceleration_mps2 = 0.0;
};

/// The path that a plan draws beside its reference line, p(s) = r(s) + d(s) n(s), evaluated exactly
/// at any station `s` of the line: nothing is sampled between the planner and the controller.
class PlannedPath {
 public:
  using Lateral = std::function<LateralState(double s_m)>;

  /// @param line     outlives the path.
  /// @param lateral  d, d′ and d″ at a station.
  PlannedPath(const ReferenceLine& line, Lateral lateral);

  LateralState lateral_at(double s_m) const { return lateral_(s_m); }

  /// Pose of the rear axle.
  geometry::Pose2 pose_at(double s_m) const { return place_at(s_m).pose; }

  double curvature_per_m(double s_m) const { return place_at(s_m).curvature_per_m; }

  /// Both at once.
  struct Place {
    geometry::Pose2 pose;
    double curvature_per_m;
    double stretch;  ///< metres of the path per metre of the line
  };
  Place place_at(double s_m) const;

  /// Pose of the front axle's centre on the path that it draws while the rear axle follows this
  /// one: position p + L t, heading ψ + atan(L k).
  geometry::Pose2 front_pose_at(double s_m, double wheelbase_m) const;

  /// Station at which the front axle's path is nearest to a point, searched near `near_s_m` by
  /// Newton steps.
  double nearest_front_s_m(const Eigen::Vector2d& front_in_map, double wheelbase_m,
                           double near_s_m) const;

 private:
  const ReferenceLine* line_;
  Lateral lateral_;
};

/// State of a vehicle beside the line, for planning from where it is.
/// @param curvature_per_m  of the rear axle's path, tan δ / L.
/// @param near_s_m         station to search the foot of the perpendicular near.
LateralState lateral_state(const ReferenceLine& line, const geometry::Pose2& map_from_vehicle,
                           double curvature_per_m, double near_s_m);

}  // namespace roadbed::planning::lateral
