#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "roadbed/geometry/motion/rectangle.h"
#include "roadbed/geometry/motion/vehicle_shape.h"
#include "roadbed/planning/obstacles/movers_on_line.h"
#include "roadbed/planning/obstacles/obstacle.h"
#include "roadbed/planning/reference/reference_line.h"

namespace roadbed::planning::inline maneuvers {

/// The obstacles with cyclists made so wide that the clearance beside them is 1.5 m (German StVO §
/// 5 (4), in towns): those that ride (not stand) as the vehicle heads, and are not beside it nearer
/// than that already. None: nobody is a cyclist. Copies all.
std::optional<std::vector<Obstacle>> with_room_beside_cyclists(std::span<const Obstacle> obstacles,
                                                               double t_s,
                                                               const geometry::Rectangle& body,
                                                               double clearance_m);

/// Whether somebody slower may be passed without leaving the lane.
struct WithinLanePassing {
  std::optional<std::size_t> passed = {};  ///< obstacle that there is room beside
  std::string reason = {};                 ///< which metres are missing; empty: none, or nobody
};

struct WithinLaneQuestion {
  const ViewOnLine& view;
  const ReferenceLine& line;
  const geometry::VehicleShape& vehicle;
  double free_mps = 0.0;     ///< of the road without the others
  double clearance_m = 0.0;  ///< asked for beside them
  /// Greatest offsets from the line, to the left and to the right, that the vehicle may drive at.
  double most_left_m = 0.0, most_right_m = 0.0;
};

/// The nearest one that moves ahead on the line and is 1 m/s slower than the road allows, if the
/// vehicle is 25 m behind it, or 8 s: whether the corridor is wide enough on one of its sides.
/// Nobody is passed who brakes, or queues behind somebody.
WithinLanePassing look_within_lane(const WithinLaneQuestion& question);

}  // namespace roadbed::planning::maneuvers
