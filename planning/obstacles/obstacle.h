#pragma once

#include <string>

#include "roadbed/geometry/motion/trajectory.h"

namespace roadbed::planning::inline obstacles {

/// Seconds of a drive.
struct TimeSpan {
  double from_s = 0.0, to_s = 0.0;
};

/// A rectangle that stands or moves. Its pose is its centre (not an axle) in the map.
struct Obstacle {
  std::string id;
  std::string kind = "car";  ///< "car", "truck", "pedestrian", "static", …
  double length_m = 4.5;
  double width_m = 1.8;
  geometry::Trajectory motion;  ///< where it is, or will be; one point: it stands for ever

  bool is_static() const { return motion.points().size() == 1; }
};

}  // namespace roadbed::planning::obstacles
