#include "roadbed/tools/support/audit_frames.h"

#include <fmt/format.h>

#include <utility>

#include "roadbed/map/input_error.h"

namespace roadbed::tools {
namespace {

void extend(std::optional<map::Box2>& box, const Eigen::Vector2d& least,
            const Eigen::Vector2d& most) {
  if (!box) box = map::Box2{least, most};
  box->min_in_source = box->min_in_source.cwiseMin(least);
  box->max_in_source = box->max_in_source.cwiseMax(most);
}

}  // namespace

std::vector<geometry::Ring> drivable_rings(const map::RoadMap& road_map) {
  std::vector<geometry::Ring> rings;
  for (const map::Lane& lane : road_map.lanes()) {
    if (!is_drivable(lane.type)) continue;
    geometry::Ring ring;
    for (const Eigen::Vector2d& point : lane.polygon) ring.push_back(road_map.to_source(point));
    rings.push_back(std::move(ring));
  }
  return rings;
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

void check_overlap(const std::vector<geometry::Ring>& lanes,
                   const std::optional<map::Box2>& measured, const std::string& occupancy) {
  std::optional<map::Box2> roads;
  for (const geometry::Ring& lane : lanes) {
    for (const Eigen::Vector2d& point : lane) extend(roads, point, point);
  }
  if (!roads || !measured || overlap(*roads, *measured)) return;
  throw map::InputError({.file = occupancy,
                         .place = {},
                         .element = {},
                         .found = fmt::format("covers {}", text_of(*measured)),
                         .needed = fmt::format("the map's {}", text_of(*roads)),
                         .remedy = "bring map and occupancy into one frame"});
}

std::vector<map::Box2> occupied_boxes(const map::OccupancySource& occupancy,
                                      const map::HeightBand& band, const map::Box2& around) {
  std::vector<map::Box2> boxes;
  constexpr double any_height_m = 1e6;
  const Eigen::Vector2d &least = around.min_in_source, &most = around.max_in_source;
  for (const map::OccupancyCell& cell : occupancy.cells_in(
           {{least.x(), least.y(), -any_height_m}, {most.x(), most.y(), any_height_m}})) {
    const double half_m = 0.5 * cell.size_m, z_m = cell.centre_in_source.z();
    if (cell.state != map::CellState::occupied) continue;
    const Eigen::Array2d centre = cell.centre_in_source.head<2>();
    if (!band.holds(centre.matrix(), z_m - half_m, 2.0 * half_m)) continue;
    boxes.push_back({centre - half_m, centre + half_m});
  }
  return boxes;
}

}  // namespace roadbed::tools
