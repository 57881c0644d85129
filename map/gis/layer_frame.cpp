#include "roadbed/map/gis/layers.h"

#include "roadbed/map/files/projection.h"

namespace roadbed::map::inline gis {
namespace {

template <typename Change>
void for_each_point(std::vector<Layer>& layers, const Change& change) {
  for (Layer& layer : layers) {
    for (Feature& feature : layer.features) {
      for (auto& polygon : feature.shape) {
        for (Points& ring : polygon) {
          for (Eigen::Vector3d& point : ring) change(point);
        }
      }
    }
  }
}

}  // namespace

Eigen::AlignedBox2d box_of(const Shape& shape) {
  Eigen::AlignedBox2d box;
  for (const auto& rings : shape) {
    // Holes are inside the first ring.
    for (const Eigen::Vector3d& point : rings[0]) box.extend(Eigen::Vector2d(point.head<2>()));
  }
  return box;
}

void to_source(const RoadMap& road_map, std::vector<Layer>& layers) {
  for_each_point(layers, [&](Eigen::Vector3d& point) {
    point.head<2>() = road_map.to_source(point.head<2>());
  });
}

void source_to_crs(const RoadMap& road_map, std::vector<Layer>& layers) {
  const CrsOffset& offset = road_map.offset_in_crs();
  if (offset == CrsOffset{}) return;
  const geometry::Pose2 crs_from_source{offset.x_m, offset.y_m, offset.heading_rad};
  for_each_point(layers, [&](Eigen::Vector3d& point) {
    point.head<2>() = crs_from_source * Eigen::Vector2d(point.head<2>());
    point.z() += offset.z_m;
  });
}

void to_lon_lat(const std::string& crs, std::vector<Layer>& layers) {
  std::vector<Eigen::Vector2d> points;
  for_each_point(layers, [&](Eigen::Vector3d& point) { points.push_back(point.head<2>()); });
  map::to_lon_lat(crs, points);
  auto next = points.begin();
  for_each_point(layers, [&](Eigen::Vector3d& point) { point.head<2>() = *next++; });
}

}  // namespace roadbed::map::gis
