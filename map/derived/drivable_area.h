#pragma once

#include <Eigen/Core>
#include <vector>

#include "roadbed/geometry/motion/region_edges.h"
#include "roadbed/geometry/polygons/polygon.h"
#include "roadbed/map/derived/surface.h"

namespace roadbed::map::inline derived {

/// Answers whether points are on the drivable surface, and how far its edge is.
class DrivableArea {
 public:
  /// Takes the union of all drivable lanes, see surface.h for its cost.
  explicit DrivableArea(const RoadMap& road_map, const SurfaceOptions& options = {});

  /// @param polygons  with disjoint insides, as `unite` makes them.
  explicit DrivableArea(std::vector<geometry::Polygon> polygons);

  /// Whether the point is on the surface or its edge. O(log N) on average, exact.
  bool contains(const Eigen::Vector2d& point_in_map) const { return edges_.contains(point_in_map); }

  /// Distance to the nearest edge of the surface [m], negative off the surface; minus infinity
  /// where there is no surface at all. O(log N) on average.
  double signed_distance_m(const Eigen::Vector2d& point_in_map) const;

  const std::vector<geometry::Polygon>& polygons() const { return polygons_; }

 private:
  std::vector<geometry::Polygon> polygons_;
  geometry::RegionEdges edges_;
};

}  // namespace roadbed::map::derived
