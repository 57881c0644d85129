#include "roadbed/map/opendrive/write/road_lines.h"

#include <algorithm>
#include <cmath>

#include "roadbed/geometry/primitives/disjoint_sets.h"

namespace roadbed::map::opendrive {
namespace {

constexpr double kBeyond_m = 8.0;     // of the lanes before and behind
constexpr int kMostHops = 8;          // over lanes on the way there
constexpr double kSamePoint_m = 0.3;  // to where a border goes on

Line3 border_of(const Lane& lane, bool forward, bool on_left) {
  const LaneLine& line = on_left == forward ? lane.left : lane.right;
  const auto& points = line.in_map.points();
  Line3 border;
  border.reserve(points.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    const std::size_t place = forward ? i : points.size() - 1 - i;
    border.emplace_back(points[place].x(), points[place].y(), line.z_m[place]);
  }
  return border;
}

// The lane that one leads to, or comes from, along the road.
const std::vector<LaneId>& linked(const RoadMap& road_map, const PlannedLane& lane, bool ahead) {
  const LaneLinks& links = road_map.graph().of(lane.lane);
  return lane.forward == ahead ? links.successors : links.predecessors;
}

// Some metres of the border that goes on from an end of one, over several lanes if need be.
Line3 beyond(const RoadMap& road_map, PlannedLane lane, bool on_left, bool ahead,
             Eigen::Vector3d end) {
  Line3 line;
  double length_m = 0.0;
  for (int hop = 0; hop < kMostHops && length_m < kBeyond_m; ++hop) {
    Line3 next;
    for (const LaneId id : linked(road_map, lane, ahead)) {
      next = border_of(road_map.lane(id), lane.forward, on_left);
      if (!ahead) std::reverse(next.begin(), next.end());
      lane.lane = id;
      if ((next.front() - end).head<2>().norm() <= kSamePoint_m) break;
      next.clear();
    }
    if (next.empty()) break;
    for (std::size_t i = 1; i < next.size() && length_m < kBeyond_m; ++i) {
      length_m += (next[i] - next[i - 1]).head<2>().norm();
      line.push_back(next[i]);
    }
    end = next.back();
  }
  return line;
}

// Unit vectors along a sampled curve at its points; a corner is none of a curve.
std::vector<Eigen::Vector2d> tangents(const Line3& points) {
  constexpr double corner_rad = 0.35;
  std::vector<Eigen::Vector2d> along(points.size() - 1);
  std::vector<double> length_m(along.size());
  for (std::size_t i = 0; i < along.size(); ++i) {
    along[i] = (points[i + 1] - points[i]).head<2>();
    length_m[i] = along[i].norm();
    along[i] /= length_m[i];
  }
  // A chord's direction is that of the curve in its middle.
  const auto between = [&](std::size_t i, double share) -> Eigen::Vector2d {
    const bool is_corner = along[i].dot(along[i + 1]) < std::cos(corner_rad);
    if (is_corner) return along[share < 0.5 ? i : i + 1];
    return (along[i] + share * (along[i + 1] - along[i])).normalized();
  };
  std::vector<Eigen::Vector2d> made(points.size(), along.front());
  made.back() = along.back();
  if (along.size() < 2) return made;
  for (std::size_t i = 0; i + 1 < along.size(); ++i) {
    made[i + 1] = between(i, length_m[i] / (length_m[i] + length_m[i + 1]));
  }
  made.front() = between(0, -length_m[0] / (length_m[0] + length_m[1]));
  const std::size_t last = along.size() - 1;
  made.back() = between(last - 1, 1.0 + length_m[last] / (length_m[last - 1] + length_m[last]));
  return made;
}

// A sampled curve with points between its own, by Hermite's cubics where they are not farther from
// a chord than the curve is.
Line3 with_bends(const Line3& points) {
  constexpr double straight_m = 1e-5, sampled_within_m = 1.25e-3;
  const std::vector<Eigen::Vector2d> along = tangents(points);
  Line3 made{points.front()};
  for (std::size_t i = 1; i < points.size(); ++i) {
    const Eigen::Vector2d chord = (points[i] - points[i - 1]).head<2>();
    const double length_m = chord.norm();
    const double bend_m = 0.125 * length_m * (along[i] - along[i - 1]).norm();
    for (const double u : {0.25, 0.5, 0.75}) {
      if (bend_m < straight_m || bend_m > sampled_within_m) break;
      const Eigen::Vector2d off =
          u * (1.0 - u) *
          ((1.0 - u) * (length_m * along[i - 1] - chord) - u * (length_m * along[i] - chord));
      const Eigen::Vector2d at = points[i - 1].head<2>() + u * chord + off;
      made.emplace_back(at.x(), at.y(), 0.0);
    }
    made.push_back(points[i]);
  }
  return made;
}

// What a line has beyond the end of another one that runs along it.
Line3 longer_part(const Line3& line, const Line3& other, bool ahead) {
  constexpr double longer_m = 1e-3;
  const Eigen::Vector3d& end = ahead ? other.back() : other.front();
  const Eigen::Vector3d& before = ahead ? *(other.end() - 2) : *(other.begin() + 1);
  const Eigen::Vector2d along = (end - before).head<2>().normalized();
  Line3 part;
  for (std::size_t i = 0; i < line.size(); ++i) {
    const Eigen::Vector3d& point = line[ahead ? line.size() - 1 - i : i];
    const Eigen::Vector2d off = (point - end).head<2>();
    const double beyond_m = along.dot(off);
    if (beyond_m < longer_m || off.norm() > beyond_m + kSamePoint_m) break;
    part.insert(part.begin(), point);
  }
  return part;
}

std::optional<std::uint32_t> end_at(const RoadPlan& plan, LaneId id, bool exit) {
  const auto& place = plan.places[id.index];
  if (!place) return {};
  const PlannedRoad& road = plan.roads[place->road];
  const bool at_end = road.sections[place->section].lanes[place->lane].forward == exit;
  if (place->section != (at_end ? road.sections.size() - 1 : 0)) return {};
  return 2 * place->road + (at_end ? 1 : 0);
}

}  // namespace

RoadBorder border_along(const RoadMap& road_map, const PlannedSection& section, std::size_t place) {
  const bool on_left = place < section.lanes.size();
  const PlannedLane& lane = section.lanes[on_left ? place : place - 1];
  const PlannedLane& other = section.lanes[place == 0 ? 0 : place - 1];
  const Line3 own = border_of(road_map.lane(lane.lane), lane.forward, on_left);
  const auto going_on = [&](bool ahead) {
    const Eigen::Vector3d& end = ahead ? own.back() : own.front();
    Line3 next = beyond(road_map, lane, on_left, ahead, end);
    if (next.empty()) next = beyond(road_map, other, on_left && place == 0, ahead, end);
    if (!next.empty() || other.lane == lane.lane) return next;
    return longer_part(border_of(road_map.lane(other.lane), other.forward, false), own, ahead);
  };
  RoadBorder border{going_on(false), 0, 0};
  std::reverse(border.points.begin(), border.points.end());
  border.own_from = border.points.size();
  border.points.insert(border.points.end(), own.begin(), own.end());
  border.own_to = border.points.size() - 1;
  const Line3 behind = going_on(true);
  border.points.insert(border.points.end(), behind.begin(), behind.end());
  return border;
}

RoadBorder reference_along(const RoadMap& road_map, const PlannedRoad& road, std::size_t border) {
  if (!road.source) return border_along(road_map, road.sections.front(), border);
  const Road& source = road_map.road(*road.source);
  double low_m = 1e300, high_m = -1e300;
  for (const PlannedSection& section : road.sections) {
    const LaneOrigin& origin = road_map.lane(section.lanes.front().lane).origin;
    low_m = std::min({low_m, origin.road_from_s_m, origin.road_to_s_m});
    high_m = std::max({high_m, origin.road_from_s_m, origin.road_to_s_m});
  }
  const auto& s_m = source.reference_road_s_m;
  const auto& points = source.reference_in_map.points();
  Line3 line;
  const auto add = [&](std::size_t i, double share) {
    const Eigen::Vector2d at = points[i - 1] + share * (points[i] - points[i - 1]);
    line.emplace_back(at.x(), at.y(), 0.0);
  };
  for (std::size_t i = 1; i < points.size(); ++i) {
    const double step_m = s_m[i] - s_m[i - 1];
    if (step_m <= 0.0 || s_m[i] <= low_m || s_m[i - 1] >= high_m) continue;
    if (line.empty()) add(i, std::max(0.0, (low_m - s_m[i - 1]) / step_m));
    add(i, std::min(1.0, (high_m - s_m[i - 1]) / step_m));
  }
  line = with_bends(line);
  const std::size_t last = line.size() - 1;
  return {std::move(line), 0, last};
}

std::optional<std::uint32_t> exit_end(const RoadPlan& plan, LaneId lane) {
  return end_at(plan, lane, true);
}
std::optional<std::uint32_t> entry_end(const RoadPlan& plan, LaneId lane) {
  return end_at(plan, lane, false);
}

std::vector<std::uint32_t> joined_ends(const RoadMap& road_map, const RoadPlan& plan) {
  geometry::DisjointSets sets(2 * plan.roads.size());
  for (const Lane& lane : road_map.lanes()) {
    const auto from = exit_end(plan, lane.id);
    if (!from) continue;
    for (const LaneId next : road_map.graph().of(lane.id).successors) {
      const auto to = entry_end(plan, next);
      if (to) sets.join(*from, *to);
    }
  }
  std::vector<std::uint32_t> group;
  for (std::size_t end = 0; end < 2 * plan.roads.size(); ++end) {
    group.push_back(static_cast<std::uint32_t>(sets.of(end)));
  }
  return group;
}

}  // namespace roadbed::map::opendrive
