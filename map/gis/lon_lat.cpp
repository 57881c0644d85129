#include "roadbed/map/gis/lon_lat.h"

#include "roadbed/geometry/primitives/pose2.h"
#include "roadbed/map/files/input_error.h"
#include "roadbed/map/files/projection.h"

namespace roadbed::map::inline gis {
namespace {

const std::string& known_crs(const RoadMap& road_map) {
  if (!road_map.crs().empty()) return road_map.crs();
  throw InputError({.file = "longitude and latitude",
                    .found = "the map names no coordinate system",
                    .needed = "one, for its coordinates to have a place on the globe",
                    .remedy = "name it with roadbed import --crs"});
}

geometry::Pose2 crs_from_source(const RoadMap& road_map) {
  const CrsOffset& offset = road_map.offset_in_crs();
  return {offset.x_m, offset.y_m, offset.heading_rad};
}

}  // namespace

void source_to_lon_lat(const RoadMap& road_map, std::span<Eigen::Vector2d> points) {
  const std::string& crs = known_crs(road_map);
  const geometry::Pose2 pose = crs_from_source(road_map);
  for (Eigen::Vector2d& point : points) point = pose * point;
  map::to_lon_lat(crs, points);
}

void lon_lat_to_source(const RoadMap& road_map, std::span<Eigen::Vector2d> points) {
  map::from_lon_lat(known_crs(road_map), points);
  const geometry::Pose2 pose = crs_from_source(road_map).inverse();
  for (Eigen::Vector2d& point : points) point = pose * point;
}

}  // namespace roadbed::map::gis
