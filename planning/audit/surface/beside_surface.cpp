#include "roadbed/planning/audit/surface/beside_surface.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include "roadbed/geometry/polygons/polygon.h"
#include "roadbed/geometry/primitives/angle.h"

namespace roadbed::planning::inline audit {
namespace {

using Kind = BesideSurface::Kind;
using map::LaneType;

Kind kind_of(const map::Lane& lane, bool is_against) {
  switch (lane.type) {
    case LaneType::shoulder:
    case LaneType::stop:
      return Kind::shoulder;
    case LaneType::parking:
      return Kind::parking;
    case LaneType::sidewalk:
      return Kind::pavement;
    case LaneType::biking:
      return Kind::cycle_path;
    case LaneType::none:
    case LaneType::border:
    case LaneType::curb:
    case LaneType::median:
      return Kind::verge;
    default:
      break;
  }
  if (!map::is_surface(lane.type)) return Kind::other;
  return is_against && lane.one_way ? Kind::oncoming_lane : Kind::lane;
}

/// Of several lanes at a place the drivable one counts most, then the first.
std::optional<BesideSurface> lane_at(const map::RoadMap& road_map, const Eigen::Vector2d& in_map,
                                     double heading_rad) {
  constexpr double within_m = 1e-3;
  std::optional<BesideSurface> best;
  for (const map::LaneMatch& match : road_map.locate(in_map, within_m, false)) {
    const map::Lane& lane = road_map.lane(match.place.lane);
    const double turned_rad = geometry::wrap_angle(heading_rad - match.heading_rad);
    const bool is_against = std::abs(turned_rad) > 0.5 * std::numbers::pi;
    if (best && !map::is_drivable(lane.type)) continue;
    best = {kind_of(lane, is_against), lane.name, std::string(map::to_string(lane.type))};
    if (map::is_drivable(lane.type)) return best;
  }
  return best;
}

std::optional<BesideSurface> area_at(const map::RoadMap& road_map, const Eigen::Vector2d& in_map) {
  for (const map::Area& area : road_map.areas()) {
    const auto holds = [&](const geometry::Polygon& polygon) {
      return geometry::contains(polygon, in_map);
    };
    if (std::ranges::any_of(area.in_map, holds)) {
      return BesideSurface{Kind::other, area.source_id, area.type};
    }
  }
  return std::nullopt;
}

/// Whether the surface goes on not far behind the point, seen from the edge that was left.
bool is_gap(const geometry::RegionEdges& edges, const Eigen::Vector2d& point,
            const Eigen::Vector2d& edge) {
  constexpr double widest_m = 3.0, step_m = 0.05;
  const Eigen::Vector2d way = point - edge;
  if (!(way.norm() > 0.0)) return false;
  const Eigen::Vector2d ahead = way.normalized();
  for (double far_m = way.norm(); far_m <= widest_m; far_m += step_m) {
    if (edges.contains(edge + far_m * ahead)) return true;
  }
  return false;
}

}  // namespace

std::string_view to_string(Kind kind) {
  constexpr std::array<std::string_view, 10> names{
      "unmapped", "gap",     "oncoming lane", "lane",       "shoulder",
      "verge",    "parking", "pavement",      "cycle path", "other"};
  return names[static_cast<std::size_t>(kind)];
}

std::string text_of(const BesideSurface& beside) {
  switch (beside.kind) {
    case Kind::unmapped:
      return "where the map says nothing";
    case Kind::gap:
      return "a gap in the map";
    default:
      return fmt::format("{}, {} ({})", to_string(beside.kind), beside.name, beside.type);
  }
}

BesideSurface what_is_beside(const map::RoadMap* road_map, const geometry::RegionEdges& edges,
                             const Eigen::Vector2d& point, const Eigen::Vector2d& edge,
                             double heading_rad) {
  if (road_map != nullptr) {
    const Eigen::Vector2d in_map = road_map->to_map(point);
    if (auto lane = lane_at(*road_map, in_map, heading_rad)) return *lane;
    if (auto area = area_at(*road_map, in_map)) return *area;
  }
  return {.kind = is_gap(edges, point, edge) ? Kind::gap : Kind::unmapped};
}

}  // namespace roadbed::planning::audit
