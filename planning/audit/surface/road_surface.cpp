#include "roadbed/planning/audit/surface/road_surface.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <set>
#include <utility>

#include "roadbed/geometry/primitives/angle.h"
#include "roadbed/map/derived/surface.h"
#include "roadbed/map/files/input_error.h"
#include "roadbed/map/index/road_map_index.h"
#include "roadbed/planning/audit/surface/drive_level.h"

namespace roadbed::planning::inline audit {
namespace {

using Eigen::Vector2d;
using geometry::Box;
using geometry::Polygon;
using geometry::Ring;
using map::LaneId;
using map::RoadMap;
using RuleKind = SurfaceRule::Kind;

/// Lanes in order of id.
using Lanes = std::set<LaneId>;

constexpr double kPiece_m = 50.0;  // of a drive, that has a box of its own

// Boxes around pieces of the drive, grown by a margin, in coordinates of the map.
std::vector<Box> boxes_along(const RoadMap& road_map, const geometry::Trajectory& drive,
                             double margin_m) {
  std::vector<Box> boxes;
  Box piece;
  const auto close = [&] {
    const Vector2d margin = Vector2d::Constant(margin_m);
    boxes.emplace_back(piece.min() - margin, piece.max() + margin);
  };
  for (const geometry::TrajectoryPoint& sample : drive.points()) {
    const Vector2d at = road_map.to_map({sample.x_m, sample.y_m});
    piece.extend(at);
    if (piece.sizes().maxCoeff() < kPiece_m) continue;
    close();
    piece = Box(at);
  }
  close();
  return boxes;
}

Lanes lanes_of_type(const RoadMap& road_map, const std::vector<Box>& boxes,
                    const map::LaneTypes& types) {
  Lanes lanes;
  for (const Box& box : boxes) {
    const auto found = road_map.index().lanes.in_box(box.min(), box.max(), types);
    lanes.insert(found.begin(), found.end());
  }
  return lanes;
}

// In coordinates of the map, at most so far apart.
std::vector<geometry::Pose2> poses_along(const RoadMap& road_map, const geometry::Trajectory& drive,
                                         double apart_m) {
  std::vector<geometry::Pose2> poses;
  const auto take = [&](const geometry::TrajectoryPoint& state) {
    const Vector2d at = road_map.to_map({state.x_m, state.y_m});
    poses.push_back({at.x(), at.y(), state.heading_rad});
  };
  const auto& samples = drive.points();
  take(samples.front());
  for (std::size_t i = 1; i < samples.size(); ++i) {
    const double way_m =
        std::hypot(samples[i].x_m - samples[i - 1].x_m, samples[i].y_m - samples[i - 1].y_m);
    const double steps = std::max(1.0, std::ceil(way_m / apart_m));
    for (double step = 1.0; step <= steps; ++step) {
      take(geometry::interpolate(samples[i - 1], samples[i], step / steps));
    }
  }
  return poses;
}

// Without those that are less than so far from the one before, but the last: rows may be dense.
std::vector<geometry::Pose2> thinned(const std::vector<geometry::Pose2>& poses, double least_m) {
  std::vector<geometry::Pose2> kept;
  for (const geometry::Pose2& pose : poses) {
    const bool is_far =
        kept.empty() || (pose.position() - kept.back().position()).norm() >= least_m;
    if (is_far || &pose == &poses.back()) kept.push_back(pose);
  }
  return kept;
}

// Lanes whose middle runs the drive's way where its rear axle is in them; where it is in none, the
// nearest one that does.
Lanes lanes_driven(const RoadMap& road_map, const geometry::Trajectory& drive) {
  constexpr double within_m = 3.0, inside_m = 0.05;
  constexpr std::size_t most = 16;
  const std::vector<geometry::Pose2> poses = poses_along(road_map, drive, 0.5);
  std::vector<Vector2d> points;
  for (const geometry::Pose2& pose : poses) points.push_back(pose.position());
  const map::LaneMatches matches = road_map.locate(points, within_m, most, true);
  Lanes lanes;
  for (std::size_t i = 0; i < poses.size(); ++i) {
    bool is_in_one = false;
    for (const map::LaneMatch& match : matches.of(i)) {  // the nearest first
      const double turned_rad = geometry::wrap_angle(poses[i].heading_rad - match.heading_rad);
      const bool is_along =
          std::abs(turned_rad) < 0.5 * std::numbers::pi || !road_map.lane(match.place.lane).one_way;
      if (!is_along || (match.distance_m > inside_m && is_in_one)) continue;
      lanes.insert(match.place.lane);
      is_in_one = true;
    }
  }
  return lanes;
}

void add_beside(const RoadMap& road_map, LaneId lane, Lanes& lanes) {
  for (const auto& side : {road_map.graph().of(lane).left, road_map.graph().of(lane).right}) {
    if (!side || !side->same_direction || !map::is_drivable(road_map.lane(side->lane).type))
      continue;
    if (lanes.insert(side->lane).second) add_beside(road_map, side->lane, lanes);
  }
}

// Lanes that a body of this length reaches from one, ahead or behind.
void add_linked(const RoadMap& road_map, LaneId lane, double reach_m, bool is_ahead, Lanes& lanes) {
  const map::LaneLinks& links = road_map.graph().of(lane);
  for (const LaneId next : is_ahead ? links.successors : links.predecessors) {
    if (!map::is_drivable(road_map.lane(next).type)) continue;
    lanes.insert(next);
    const double left_m = reach_m - road_map.lane(next).length_m();
    if (left_m > 0.0) add_linked(road_map, next, left_m, is_ahead, lanes);
  }
}

// With all beside them, and what the body reaches from their ends.
Lanes lanes_along(const RoadMap& road_map, const geometry::Trajectory& drive, double reach_m) {
  const Lanes driven = lanes_driven(road_map, drive);
  Lanes lanes = driven;
  for (const LaneId lane : driven) {
    add_linked(road_map, lane, reach_m, true, lanes);
    add_linked(road_map, lane, reach_m, false, lanes);
  }
  for (const LaneId lane : Lanes(lanes)) add_beside(road_map, lane, lanes);
  return lanes;
}

Ring in_source(const RoadMap& road_map, Ring ring) {
  for (Vector2d& point : ring) point = road_map.to_source(point);
  return ring;
}

Polygon in_source(const RoadMap& road_map, Polygon polygon) {
  polygon.outer = in_source(road_map, std::move(polygon.outer));
  for (Ring& hole : polygon.holes) hole = in_source(road_map, std::move(hole));
  return polygon;
}

void add_areas(const RoadMap& road_map, const std::vector<Box>& boxes,
               std::vector<Polygon>& polygons) {
  for (const map::Area& area : road_map.areas()) {
    if (!area.is_road) continue;
    for (const Polygon& polygon : area.in_map) {
      const Box box = geometry::box_around(polygon.outer);
      if (std::ranges::none_of(boxes, [&](const Box& other) { return other.intersects(box); }))
        continue;
      polygons.push_back(in_source(road_map, polygon));
    }
  }
}

map::LaneTypes types_of(RuleKind kind) {
  return kind == RuleKind::surface ? map::LaneTypes::surface() : map::LaneTypes::drivable();
}

bool has_any(const RoadMap& road_map, const map::LaneTypes& types) {
  const auto is_of_type = [&](const map::Lane& lane) { return types.has(lane.type); };
  return std::ranges::any_of(road_map.lanes(), is_of_type) ||
         std::ranges::any_of(road_map.areas(), &map::Area::is_road);
}

Lanes lanes_of(const SurfaceRule& rule, const geometry::Trajectory& drive,
               const std::vector<Box>& boxes, double reach_m) {
  if (rule.kind == RuleKind::route) return {rule.route.begin(), rule.route.end()};
  const RoadMap& road_map = *rule.road_map;
  Lanes lanes = rule.kind == RuleKind::lanes ? lanes_along(road_map, drive, reach_m)
                                             : lanes_of_type(road_map, boxes, types_of(rule.kind));
  constexpr double least_m = 1.0, most_m = 2.0, beside_m = 5.0;
  return lanes_on_level(road_map, std::move(lanes),
                        thinned(poses_along(road_map, drive, most_m), least_m), reach_m + beside_m);
}

}  // namespace

std::string_view to_string(RuleKind kind) {
  constexpr std::array<std::string_view, 5> names{"drivable", "surface", "lanes", "route", "area"};
  return names[static_cast<std::size_t>(kind)];
}

std::vector<Polygon> surface_polygons(const SurfaceRule& rule, const geometry::Trajectory& drive,
                                      double reach_m) {
  if (rule.kind == RuleKind::area) return rule.area_in_source;
  const RoadMap& road_map = *rule.road_map;
  std::vector<Box> boxes;
  if (rule.kind != RuleKind::route) {
    boxes = boxes_along(road_map, drive, reach_m + kSurfaceHorizon_m);
  }
  std::vector<Polygon> polygons;
  for (const LaneId id : lanes_of(rule, drive, boxes, reach_m)) {
    const Ring& ring = road_map.lane(id).polygon;
    if (ring.size() > 2) polygons.push_back({in_source(road_map, ring), {}});
  }
  const bool has_areas = rule.kind == RuleKind::drivable || rule.kind == RuleKind::surface;
  if (has_areas) add_areas(road_map, boxes, polygons);
  if (polygons.empty() && has_areas && !has_any(road_map, types_of(rule.kind))) {
    throw map::InputError({.file = "map",
                           .found = "no drivable lane and no road area",
                           .needed = "a surface to stay on",
                           .remedy = "give another map, or --on area:F.geojson"});
  }
  return polygons;
}

RoadSurface road_surface(const std::vector<Polygon>& polygons_in_source, double seam_m) {
  if (polygons_in_source.empty()) return {};
  // Unions are made near the origin, where coordinates have digits to spare.
  const Vector2d origin = polygons_in_source.front().outer.front();
  const auto moved = [](std::vector<Polygon> polygons, const Vector2d& by) {
    for (Polygon& polygon : polygons) {
      for (Vector2d& point : polygon.outer) point += by;
      for (Ring& hole : polygon.holes) {
        for (Vector2d& point : hole) point += by;
      }
    }
    return polygons;
  };
  map::Surface surface = map::surface_of(moved(polygons_in_source, -origin), {.weld_m = seam_m});
  RoadSurface road{.polygons_in_source = moved(std::move(surface.polygons), origin),
                   .edges = {},
                   .off_by_m = 2.0 * surface.most_moved_m};
  road.edges = geometry::RegionEdges(road.polygons_in_source);
  return road;
}

}  // namespace roadbed::planning::audit
