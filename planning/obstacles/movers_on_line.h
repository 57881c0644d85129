#pragma once

#include <cstddef>
#include <vector>

#include "roadbed/geometry/motion/vehicle_shape.h"
#include "roadbed/planning/obstacles/traffic.h"
#include "roadbed/planning/obstacles/visibility.h"
#include "roadbed/planning/reference/reference_line.h"

namespace roadbed::planning::inline obstacles {

/// The vehicle on its line at one time, and who is around it.
struct ViewOnLine {
  double t_s;
  geometry::LinePosition at;  ///< of the rear axle
  double speed_mps;
  Traffic traffic;                    ///< only what is there now is looked at
  const Visibility* sight = nullptr;  ///< what of the road is seen; none: nothing is hidden
};

/// An obstacle, seen from a reference line at one time.
struct MoverOnLine {
  std::size_t obstacle;                ///< index
  double s_m, d_m;                     ///< of its centre
  double half_length_m, half_width_m;  ///< along the line, and across
  double speed_mps;                    ///< along the line; less than 0 if it is oncoming
  bool stands = false;                 ///< for the whole drive

  double rear_m() const { return s_m - half_length_m; }
  double front_m() const { return s_m + half_length_m; }

  /// Whether it is ahead of another one on the same part of the line, with no more than 15 m
  /// between them, as in a queue.
  bool is_closely_ahead_of(const MoverOnLine& other) const;

  /// Whether a vehicle whose middle is `d_m` beside the line would get into its way.
  bool shares_way(double d_m, const geometry::VehicleShape& vehicle) const;
};

/// Those that are there, in the traffic's order. A projection for each.
/// @param with_standing  those that stand for the whole drive, too.
std::vector<MoverOnLine> movers_on_line(const ReferenceLine& line, const Traffic& traffic,
                                        double t_s, bool with_standing = false);

inline constexpr double kQueue_mps = 4.0;  ///< slower is who may be in a queue

/// Whether an obstacle brakes, by 1 m/s² and more over half a second before or behind a time: it is
/// about to turn off, or to stand in a queue. Of who is measured only what is foreseen is known.
bool is_braking(const Obstacle& obstacle, double t_s);

}  // namespace roadbed::planning::obstacles
