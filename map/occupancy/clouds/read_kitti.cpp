// Velodyne scans of KITTI: x, y, z and intensity as floats, and nothing else. Those of nuScenes,
// .pcd.bin, have the ring as well.
#include <fmt/format.h>

#include <bit>
#include <cmath>
#include <cstring>

#include "roadbed/map/occupancy/clouds/attribute_filter.h"
#include "roadbed/map/occupancy/clouds/cloud_formats.h"

namespace roadbed::map::inline occupancy::inline clouds {
namespace {

static_assert(std::endian::native == std::endian::little);

// Of what is no scan, which nothing else tells, floats are soon beyond any sensor's range.
void check_is_scan(const FloatRecords& scan, const std::string& name) {
  constexpr float farthest_m = 1e5f;
  for (std::size_t i = 0; i < scan.count; ++i) {
    std::array<float, 3> point;
    std::memcpy(point.data(), scan.first + i * scan.size, sizeof point);
    for (const float value : point) {
      if (!(std::abs(value) > farthest_m)) continue;
      refuse_cloud(name, fmt::format("byte {}", i * scan.size), "point",
                   fmt::format("lies {:.3g} km away", 1e-3f * std::abs(value)),
                   "a scan of a sensor", "look whether the file is a KITTI scan");
    }
  }
}

}  // namespace

RawCloud parse_kitti(std::string_view bytes, const std::string& name, const CloudFilter& filter) {
  const bool has_ring = lower(name).find(".pcd.bin") != std::string::npos;
  const std::size_t size = (has_ring ? 5 : 4) * sizeof(float);
  if (bytes.size() % size != 0) {
    refuse_cloud(name, "", "", fmt::format("has {} bytes", bytes.size()),
                 fmt::format("{} for each point: x, y, z, intensity{}, as floats", size,
                             has_ring ? ", ring" : ""),
                 "get the whole file, or name it after its format");
  }
  RawCloud cloud;
  cloud.format = has_ring ? "nuScenes .pcd.bin" : "KITTI .bin";
  cloud.unit = LengthUnit::metre;
  cloud.is_around_sensor = true;
  const FloatRecords scan{bytes.data(), bytes.size() / size, size, 0, 4, 8};
  check_is_scan(scan, name);
  const AttributeFilter attributes(filter, {"x", "y", "z", "intensity"}, name);
  if (attributes.keeps_all()) {
    add_float_points(scan, cloud);
    return cloud;
  }
  for (std::size_t i = 0; i < scan.count; ++i) {
    const char* point = scan.first + i * scan.size;
    const auto value = [point](std::size_t k) {
      return read_scalar(point + k * sizeof(float), ScalarType::f32);
    };
    if (attributes.keeps(value)) {
      cloud.add({value(0), value(1), value(2)});
    } else {
      ++cloud.filtered_out;
    }
  }
  return cloud;
}

}  // namespace roadbed::map::occupancy::clouds
