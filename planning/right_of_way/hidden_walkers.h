#pragma once

#include <span>
#include <vector>

#include "roadbed/geometry/motion/vehicle_shape.h"
#include "roadbed/planning/obstacles/traffic.h"
#include "roadbed/planning/reference/reference_line.h"
#include "roadbed/planning/reference/speed_ceiling.h"
#include "roadbed/planning/speed/path_profile.h"
#include "roadbed/planning/task/driving_task.h"

namespace roadbed::planning::inline right_of_way {

/// Where somebody on foot may step out beside a path who cannot be seen yet: from between parked
/// cars, from behind the end of a wall.
///
///        ┌────────┐ ▒  ┌────────┐
///        │ parked │ ▒╲ │ parked │        ▒ hidden, and the way to the path is free
///        └────────┘  ╲ └────────┘  ─┬─
///     ▭▶ ─ ─ ─ ─ ─ ─ ─ ─ ─ ─ ─ ─ ─ ─┴─ aside_m
///        ├─ ahead_m ─┤
struct HiddenWalker {
  double ahead_m = 0.0;   ///< of the vehicle's front, along the path; 0 or more
  double aside_m = 0.0;   ///< from the side of its body there
  double most_mps = 0.0;  ///< at which it is to be passed
};

/// The speed at which whoever walks out at 1.4 m/s is not hit by the front: a vehicle that reacts
/// 0.5 s after he comes into sight, `aside_m` from its side, and then brakes by 8 m/s² has passed
/// him or stands when he is in its way. Walking pace (2.8 m/s) is always allowed: nothing could be
/// passed otherwise.
double speed_past_walker_mps(double aside_m);

struct WalkerQuestion {
  const PathProfile& path;    ///< from the vehicle on, up to where it is looked at
  const ReferenceLine& line;  ///< that the path's stations are of
  const geometry::VehicleShape& vehicle;
  const DrivingTask& task;
  const Traffic& traffic;
  double t_s;
};

/// Places within 4 m beside the path that what stands for good and occupied cells hide, and from
/// which the way straight to it is free; of those at which more is wanted than is good. Nobody is
/// expected behind who waits in traffic, nor where more than 60 km/h are allowed.
/// O(samples · standing obstacles nearby).
std::vector<HiddenWalker> find_hidden_walkers(const WalkerQuestion& question);

/// The greatest speed when the vehicle has driven `driven_m` further, braking no harder than
/// `deceleration_mps2` before each of them; infinite where there are none.
SpeedTarget speed_before_walkers(std::span<const HiddenWalker> walkers, double driven_m,
                                 double deceleration_mps2);

}  // namespace roadbed::planning::right_of_way
