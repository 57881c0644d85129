#pragma once

#include <cstddef>
#include <vector>

#include "roadbed/geometry/motion/rectangle.h"
#include "roadbed/map/occupancy/clouds/point_cloud.h"
#include "roadbed/map/occupancy/objects/ground_segmentation.h"

namespace roadbed::map::inline occupancy::inline objects {

/// What counts as an object.
struct ObjectOptions {
  GroundOptions ground = {};
  double tolerance_m = 0.7;      ///< points that are this near are of one object
  std::size_t least_points = 5;  ///< fewer are no object
  double tallest_m = 2.0;        ///< what is higher above the ground is in nobody's way
  double longest_m = 12.0;       ///< an object that is longer or wider is cut
  double widest_m = 3.0;
};

/// What stands above the ground, at the time of a cloud.
struct FoundObject {
  geometry::Rectangle box;  ///< around its points in plan, in source coordinates
  double bottom_m, top_m;   ///< heights of its points, z in the source
  std::size_t points;       ///< how many it has
};

/// Finds the objects above the ground: Euclidean clusters (PCL) of what segment_ground() leaves up
/// to `tallest_m` above it, each with a box of fitted_rectangle(). What is too large for one road
/// user is cut, so that boxes lie close around walls and hedges: into clusters of points that are
/// nearer to one another, down to 0.15 m and as long as nine of ten points stay in one, and what is
/// too large even then along squares of `widest_m` that stand still in the source. Objects come by
/// their first points in the cloud. O(N log N) and N · neighbours.
/// @throws InputError as segment_ground() does.
std::vector<FoundObject> find_objects(const PointCloud& cloud, const ObjectOptions& options = {});

}  // namespace roadbed::map::occupancy::objects
