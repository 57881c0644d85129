#pragma once

#include <Eigen/Core>
#include <limits>

#include "roadbed/map/occupancy/clouds/point_cloud.h"

namespace roadbed::map::inline occupancy::inline octree {

/// How clouds become an octree.
struct OccupancyOptions {
  double resolution_m = 0.1;
  /// Rays carve free space this far from the sensor; hits beyond count all the same.
  double carve_range_m = std::numeric_limits<double>::infinity();
  /// A cell with a hit is occupied. Off: as in OctoMap, each cloud changes the log-odds of a cell
  /// once, so that later rays carve it away, and hits beyond the carving range do not count.
  bool sticky_hits = true;
  /// Removal of dynamic objects, by a see-through filter: a cell with hits is free if so many
  /// clouds, and more than have a point in it, saw through it, which is to have a ray across it and
  /// no point in it. Clouds are counted up to 255. In no order; it takes away what is thin, or that
  /// rays graze, as well. 0: never.
  int remove_seen_through = 0;
};

/// Where the octree of clouds within such bounds has its origin: that of the source where the
/// octree's range allows it, else the middle.
Eigen::Vector3d tree_origin(const Box3& bounds, double resolution_m);

}  // namespace roadbed::map::occupancy::octree
