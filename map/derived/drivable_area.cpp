#include "roadbed/map/derived/drivable_area.h"

#include <limits>
#include <utility>

namespace roadbed::map::inline derived {

DrivableArea::DrivableArea(const RoadMap& road_map, const SurfaceOptions& options)
    : DrivableArea(drivable_surface(road_map, options)) {}

DrivableArea::DrivableArea(std::vector<geometry::Polygon> polygons)
    : polygons_(std::move(polygons)), edges_(polygons_) {}

double DrivableArea::signed_distance_m(const Eigen::Vector2d& point_in_map) const {
  constexpr double far_m = std::numeric_limits<double>::infinity();
  const auto nearest = edges_.nearest(point_in_map, far_m);
  if (!nearest) return -far_m;
  return nearest->is_inside ? nearest->distance_m : -nearest->distance_m;
}

}  // namespace roadbed::map::derived
