#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <vector>

#include "roadbed/geometry/motion/trajectory.h"
#include "roadbed/geometry/motion/vehicle_shape.h"
#include "roadbed/planning/audit/clearance_audit.h"
#include "roadbed/tools/simulation/drive.h"
#include "roadbed/tools/simulation/scenario.h"
#include "roadbed/tools/simulation/world.h"

namespace roadbed::tools::inline simulation {

/// What `metrics.json` holds: the verdict, extremes of speed, acceleration and tracking errors with
/// their units in the keys, time per behaviour, and the audit. See the table in this folder's
/// README. What was not measured is null.
nlohmann::ordered_json metrics_of(const Scenario& scenario, const World& world, const Drive& drive,
                                  const std::optional<planning::AuditReport>& audit);

/// The least of a time between two that drive [s], and when.
struct SafetyMetric {
  double time_s = 0.0;
  double at_s = 0.0;
};

/// Least time to collision of a drive, as nuPlan takes it: from each row on everybody keeps speed
/// and heading, looked at every 0.1 s over 3 s. None: nothing would be touched.
std::optional<SafetyMetric> least_time_to_collision(const Drive& drive, const World& world,
                                                    const geometry::VehicleShape& vehicle);

/// Least time headway to a lead: gap over own speed, where that is 1 m/s or more. None: no lead.
std::optional<SafetyMetric> least_headway(const Drive& drive);

/// Metres driven against the reference line.
double wrong_way_m(const Drive& drive);

/// Savitzky–Golay: the `derivative` of the polynomial of order `order` that fits a window of
/// equally spaced values best, at the window's middle; at both ends, of the polynomial of the first
/// and last window. A list shorter than the window is one window. As scipy's
/// savgol_filter(mode="interp"), whose windows of even length reach one value further ahead than
/// back.
/// @throws std::invalid_argument if the order is not less than the window, or negative.
std::vector<double> savitzky_golay(const std::vector<double>& values, double step_s, int window,
                                   int order, int derivative);

// What passengers bear, from nuPlan's comfort metrics (motional/nuplan-devkit,
// ego_is_comfortable.yaml); absolute, but the first two.
inline constexpr double kLeastAcceleration_mps2 = -4.05;
inline constexpr double kMostAcceleration_mps2 = 2.40;
inline constexpr double kMostLateralAcceleration_mps2 = 4.89;
inline constexpr double kMostYawAcceleration_radps2 = 1.93;
inline constexpr double kMostYawRate_radps = 0.95;
inline constexpr double kMostLongitudinalJerk_mps3 = 4.13;
inline constexpr double kMostJerk_mps3 = 8.37;

/// Extremes of a drive by which nuPlan judges comfort (ego_is_comfortable), of signals smoothed as
/// there: accelerations over 8 rows, jerks over 15, turning over 5.
struct Comfort {
  double least_longitudinal_mps2 = 0.0, most_longitudinal_mps2 = 0.0;
  double most_lateral_mps2 = 0.0;  ///< absolute, as all below
  double most_yaw_acceleration_radps2 = 0.0, most_yaw_rate_radps = 0.0;
  double most_longitudinal_jerk_mps3 = 0.0, most_jerk_mps3 = 0.0;

  /// Within nuPlan's seven bounds.
  bool is_comfortable() const;
};

/// @param drive  rows at equal steps, the last may be earlier.
Comfort comfort_of(const geometry::Trajectory& drive);

}  // namespace roadbed::tools::simulation
