#include "roadbed/tools/commands/maps/measured_ground.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <memory>

#include "roadbed/map/files/input_error.h"
#include "roadbed/map/files/read_file.h"
#include "roadbed/map/occupancy/clouds/read_point_cloud.h"
#include "roadbed/map/occupancy/ground/ground_heights.h"
#include "roadbed/map/occupancy/octree/occupancy_map.h"
#include "roadbed/map/occupancy/octree/tiled_occupancy.h"

namespace roadbed::tools::inline commands::inline maps {
namespace {

using Heights = std::vector<std::optional<double>>;

std::string box_text(const Eigen::AlignedBox2d& box) {
  return fmt::format("{:.0f},{:.0f} to {:.0f},{:.0f}", box.min().x(), box.min().y(), box.max().x(),
                     box.max().y());
}

[[noreturn]] void refuse(const std::vector<std::filesystem::path>& files,
                         const Eigen::AlignedBox2d& measured,
                         std::span<const Eigen::Vector2d> at_in_source) {
  Eigen::AlignedBox2d map_box;
  for (const Eigen::Vector2d& point : at_in_source) map_box.extend(point);
  throw map::InputError(
      {.file = map::input_name(files.front()),
       .element = "--elevation",
       .found = fmt::format("ground at no point of the map; what was measured is in {} m",
                            box_text(measured)),
       .needed = fmt::format("ground that was measured in the map's coordinates, {} m",
                             box_text(map_box)),
       .remedy = "bring one of them into the other's coordinates (--shift, --to)"});
}

void take_unknown(Heights& heights_m, const Heights& others) {
  for (std::size_t i = 0; i < heights_m.size(); ++i) {
    if (!heights_m[i]) heights_m[i] = others[i];
  }
}

}  // namespace

Heights measured_ground(const std::vector<std::filesystem::path>& files,
                        std::span<const Eigen::Vector2d> at_in_source) {
  Heights heights_m(at_in_source.size());
  std::vector<map::PointCloud> clouds;
  std::vector<std::unique_ptr<map::OccupancySource>> octrees;
  Eigen::AlignedBox2d measured;
  const auto extend = [&](const map::Box3& box) {
    measured.extend(Eigen::Vector2d(box.min_in_source.head<2>()));
    measured.extend(Eigen::Vector2d(box.max_in_source.head<2>()));
  };
  for (const std::filesystem::path& file : files) {
    const bool is_folder = map::is_folder(file);
    const std::string bytes = is_folder ? "" : map::read_file(file, map::most_unpacked_of_rows);
    if (is_folder || map::is_occupancy_file(bytes)) {
      octrees.push_back(map::open_occupancy(file));
      if (const auto box = octrees.back()->bounds()) extend(*box);
      continue;
    }
    clouds.push_back(map::point_cloud_of(file, bytes));
    map::check_is_in_metres(clouds.back());
    extend(map::bounds(clouds.back()));
  }
  if (!clouds.empty()) heights_m = map::ground_heights(clouds, at_in_source);
  for (const auto& octree : octrees) {
    take_unknown(heights_m, map::ground_heights(*octree, at_in_source));
  }
  const auto is_known = [](const std::optional<double>& height_m) { return height_m.has_value(); };
  if (std::none_of(heights_m.begin(), heights_m.end(), is_known)) {
    refuse(files, measured, at_in_source);
  }
  return heights_m;
}

}  // namespace roadbed::tools::commands::maps
