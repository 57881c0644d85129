#pragma once

#include <array>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "roadbed/geometry/trajectory.h"
#include "roadbed/geometry/vehicle_shape.h"
#include "roadbed/map/occupancy/clearance_field.h"
#include "roadbed/planning/obstacle.h"
#include "roadbed/planning/reference_line.h"

namespace roadbed::planning {

/// Where a candidate starts, in the frame of the reference line (paper eq. 13–15 at l = 0).
struct LateralState {
  double s_m = 0.0;
  double d_m = 0.0;
  double d_slope = 0.0;            ///< dd/ds
  double d_curvature_per_m = 0.0;  ///< d²d/ds²
};

/// The twelve terms of the paper's Table 1, in its order.
enum class CostTerm {
  length,
  curvature,
  curvature_rate,
  curvature_second,
  curvature_third,
  offset,
  lateral_acceleration,
  longitudinal_acceleration,
  lateral_jerk,
  longitudinal_jerk,
  consistency,
  time,
};
inline constexpr int kCostTerms = 12;
std::string_view name(CostTerm term);

using CostTerms = std::array<double, kCostTerms>;

/// Why a candidate was not taken.
enum class Rejection {
  none,              ///< feasible, only dearer
  off_road,          ///< leaves the corridor
  beyond_curvature,  ///< 1 − κ d is not safely positive, or the vehicle cannot steer it
  lateral_acceleration,
  collision,
};
std::string_view name(Rejection rejection);

/// A quintic d(l) over [0, l_e] ahead of the start (paper eq. 13–22).
struct Candidate {
  double end_d_m = 0.0;
  double end_l_m = 0.0;
  CostTerms terms{};
  double cost = 0.0;
  Rejection rejection = Rejection::none;
};

/// Speed over time ahead: the current longitudinal plan.
struct SpeedPlan {
  double speed_mps = 0.0;
  double acceleration_mps2 = 0.0;
  double target_mps = 0.0;  ///< the acceleration holds until this speed is reached
};

/// Defaults are documented in planning/README.md.
CostTerms default_weights();

struct PlanOptions {
  double d_step_m = 0.1;  ///< paper: Δd
  double l_step_m = 0.2;  ///< paper: Δl
  double max_d_m = 3.5;   ///< the grid spans ±max_d
  double min_l_m = 15.0, max_l_m = 30.0;
  int points = 31;           ///< per candidate
  int circles = 3;           ///< that cover the vehicle
  double clearance_m = 0.3;  ///< to keep from obstacles
  double max_lateral_acceleration_mps2 = 4.0;
  double border_margin_m = 0.0;  ///< to keep from the corridor's edges
  double horizon_s = 5.0;        ///< moving obstacles are checked this far ahead
  CostTerms weights = default_weights();
};

/// The question of one planning cycle.
struct PlanInput {
  const ReferenceLine& line;
  LateralState start;
  double start_t_s = 0.0;  ///< scene time at the start, for obstacles' motions
  SpeedPlan speed;
  const std::vector<Obstacle>& obstacles;
  const map::ClearanceField* static_field = nullptr;  ///< none: no occupancy
  Eigen::Vector2d origin_in_source{0, 0};             ///< source = map + origin, for the field
  std::function<double(double)>
      previous_d_m;  ///< d of the previous plan at a station; may be empty
};

/// What one planning cycle found. Having no candidate left is an answer, not an error.
struct Plan {
  std::optional<Candidate> chosen;
  LateralState start;                 ///< of the chosen candidate's quintic
  geometry::Trajectory trajectory;    ///< the chosen candidate over time; rear axle; empty if none
  std::vector<Candidate> candidates;  ///< the whole grid, d_e fastest
  std::string reason;                 ///< counts per cause if nothing is feasible

  /// d, its slope and second derivative of the chosen quintic at a station of the line.
  LateralState lateral_at(double s_m) const;
};

/// The cheapest feasible, collision-free candidate of the whole grid (paper section 3.2); ties go
/// to the smaller |d_e|, then the longer l_e. Collisions are checked lazily, cheapest first.
Plan plan_path(const PlanInput& input, const geometry::VehicleShape& vehicle,
               const PlanOptions& options = {});

}  // namespace roadbed::planning
