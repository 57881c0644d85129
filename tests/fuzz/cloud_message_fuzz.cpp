// A PointCloud2 message in; its points, as they stand and placed by poses, or InputError out.
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <optional>
#include <string_view>

#include "roadbed/map/files/input_error.h"
#include "roadbed/map/occupancy/clouds/message_points.h"

namespace {

namespace map = roadbed::map;

// Moves for a second around the stamp of the seeds.
std::optional<Eigen::Isometry3d> pose_at(std::int64_t stamp_ns) {
  constexpr std::int64_t seeds_ns = 1'700'000'000'123'456'789, half_ns = 500'000'000;
  if (stamp_ns < seeds_ns - half_ns || stamp_ns > seeds_ns + half_ns) return std::nullopt;
  const double t_s = 1e-9 * static_cast<double>(stamp_ns - seeds_ns);
  return Eigen::Translation3d(1e5 + 20.0 * t_s, 0.0, 0.5) *
         Eigen::Isometry3d(Eigen::AngleAxisd(0.6 * t_s, Eigen::Vector3d::UnitZ()));
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view bytes(reinterpret_cast<const char*>(data), size);
  // On every second input: not all seeds have what it looks at.
  map::CloudFilter filter;
  if (size % 2 == 1) filter.vehicle_box = map::Box3{{-2, -1, 0}, {3, 1, 2}};
  if (size % 4 == 3) filter.intensity = map::ValueRange{1.0, 200.0};
  for (const map::PoseAt& poses : {map::PoseAt(), map::PoseAt(pose_at)}) {
    try {
      const map::CloudMessage message = map::parse_cloud({}, {0, bytes, "message"}, "fuzz.mcap");
      const auto read =
          map::points_of_message(message, {poses, {}}, filter, "fuzz.mcap", "message");
      if (read.cloud.points.empty()) continue;
      const map::Box3 box = map::bounds(read.cloud);
      if (!(box.min_in_source.array() <= box.max_in_source.array()).all()) std::abort();
    } catch (const map::InputError&) {
    }
  }
  return 0;
}
