#include "roadbed/map/occupancy/clouds/point_cloud.h"

#include <fmt/format.h>

#include <array>

#include "roadbed/map/files/input_error.h"

namespace roadbed::map::inline occupancy::inline clouds {

std::string_view to_string(LengthUnit unit) {
  constexpr std::array<std::string_view, 5> names{"unknown", "metres", "feet", "US survey feet",
                                                  "degrees"};
  return names[static_cast<std::size_t>(unit)];
}

Box3 bounds(const PointCloud& cloud) {
  Box3 box{cloud.in_source(0), cloud.in_source(0)};
  for (std::size_t i = 1; i < cloud.points.size(); ++i) {
    const Eigen::Vector3d point = cloud.in_source(i);
    box.min_in_source = box.min_in_source.cwiseMin(point);
    box.max_in_source = box.max_in_source.cwiseMax(point);
  }
  return box;
}

void check_is_in_metres(const PointCloud& cloud) {
  if (cloud.unit == LengthUnit::unknown || cloud.unit == LengthUnit::metre) return;
  throw InputError({.file = cloud.name,
                    .element = cloud.crs,
                    .found = fmt::format("coordinates are in {}", to_string(cloud.unit)),
                    .needed = "metres",
                    .remedy = cloud.unit == LengthUnit::degree
                                  ? "project the cloud first"
                                  : "project the cloud, or scale it by 0.3048"});
}

}  // namespace roadbed::map::occupancy::clouds
