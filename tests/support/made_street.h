#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "roadbed/geometry/motion/rectangle.h"
#include "roadbed/map/occupancy/clouds/point_cloud.h"

namespace roadbed::tests {

/// A box that stands on the ground, from its bottom to its top above it.
struct MadeBody {
  geometry::Rectangle box;
  double bottom_m = 0.15, top_m = 1.5;
};

/// What a scanner above the origin sees of a street: ground every 0.25 m within `reach_m`, which
/// rises by `slope` along x and is not seen below bodies, and of each body the upright sides that
/// face the scanner, a point every 0.1 m. Noise of 1 cm.
struct MadeStreet {
  std::vector<MadeBody> bodies;
  double slope = 0.0, reach_m = 40.0;
  std::uint32_t seed = 1;

  map::PointCloud cloud() const;
  /// Which body each point of the cloud is of; -1: the ground.
  std::vector<int> body_of_point() const;
};

/// A cloud as an ASCII PCD.
std::string pcd_of(const map::PointCloud& cloud);

/// A rectangle by centre, heading, length and width.
geometry::Rectangle rectangle(double x_m, double y_m, double heading_rad, double length_m,
                              double width_m);

}  // namespace roadbed::tests
