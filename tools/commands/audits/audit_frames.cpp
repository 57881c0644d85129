#include "roadbed/tools/commands/audits/audit_frames.h"

#include <fmt/format.h>

#include <utility>

#include "roadbed/map/files/input_error.h"
#include "roadbed/map/index/road_map_index.h"

namespace roadbed::tools::inline commands::inline audits {

std::vector<geometry::Ring> drivable_rings(const map::RoadMap& road_map, const map::Box2& around) {
  std::vector<geometry::Ring> rings;
  for (const map::LaneId id : road_map.index().lanes.in_box(road_map.to_map(around.min_in_source),
                                                            road_map.to_map(around.max_in_source),
                                                            map::LaneTypes::drivable())) {
    geometry::Ring& ring = rings.emplace_back();
    for (const Eigen::Vector2d& point : road_map.lane(id).polygon) {
      ring.push_back(road_map.to_source(point));
    }
  }
  return rings;
}

std::optional<map::Box2> road_bounds(const map::RoadMap& road_map) {
  const geometry::Box box = road_map.index().lanes.box();
  if (box.isEmpty()) return std::nullopt;
  return map::Box2{road_map.to_source(box.min()), road_map.to_source(box.max())};
}

std::optional<map::Box2> measured_bounds(const map::OccupancySource& occupancy) {
  const std::optional<map::Box3> bounds = occupancy.bounds();
  if (!bounds) return std::nullopt;
  return map::Box2{bounds->min_in_source.head<2>(), bounds->max_in_source.head<2>()};
}

bool overlap(const map::Box2& a, const map::Box2& b) {
  return (a.min_in_source.array() <= b.max_in_source.array()).all() &&
         (b.min_in_source.array() <= a.max_in_source.array()).all();
}

std::string text_of(const map::Box2& box) {
  return fmt::format("x {:.1f} to {:.1f}, y {:.1f} to {:.1f}", box.min_in_source.x(),
                     box.max_in_source.x(), box.min_in_source.y(), box.max_in_source.y());
}

void check_overlap(const std::optional<map::Box2>& roads, const std::optional<map::Box2>& measured,
                   const std::string& occupancy) {
  if (!roads || !measured || overlap(*roads, *measured)) return;
  throw map::InputError({.file = occupancy,
                         .found = fmt::format("covers {}", text_of(*measured)),
                         .needed = fmt::format("the map's {}", text_of(*roads)),
                         .remedy = "bring map and occupancy into one frame"});
}

std::vector<map::Box2> occupied_boxes(const map::OccupancySource& occupancy,
                                      const map::HeightBand& band, const map::Box2& around) {
  std::vector<map::Box2> boxes;
  constexpr double any_height_m = 1e6;
  const Eigen::Vector2d &least = around.min_in_source, &most = around.max_in_source;
  const map::Box3 box{{least.x(), least.y(), -any_height_m}, {most.x(), most.y(), any_height_m}};
  occupancy.for_each_in(box, [&](const map::OccupancyCell& cell) {
    const double half_m = 0.5 * cell.size_m, z_m = cell.centre_in_source.z();
    if (cell.state != map::CellState::occupied) return;
    const Eigen::Array2d centre = cell.centre_in_source.head<2>();
    if (!band.holds(centre.matrix(), z_m - half_m, 2.0 * half_m)) return;
    boxes.push_back({centre - half_m, centre + half_m});
  });
  return boxes;
}

}  // namespace roadbed::tools::commands::audits
