#include "roadbed/planning/obstacles/lanes_ahead.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "roadbed/geometry/primitives/angle.h"

namespace roadbed::planning::inline obstacles {
namespace {

constexpr std::size_t kMostLanes = 10'000;  // lanes may run in a circle and be very short

/// The drivable lanes that follow on a lane, by how much they turn.
std::vector<map::LaneId> successors_by_turn(const map::RoadMap& road_map, map::LaneId from) {
  std::vector<map::LaneId> next;
  for (const map::LaneId lane : road_map.graph().of(from).successors) {
    if (map::is_drivable(road_map.lane(lane).type)) next.push_back(lane);
  }
  std::ranges::stable_sort(next, {},
                           [&](map::LaneId lane) { return turned_along_rad(road_map.lane(lane)); });
  return next;
}

// Lanes that join do so but for rounding, in real files within centimetres: a point that is not
// ahead of the last one would turn whoever drives along by up to 180°.
bool repeats_joint(const std::vector<Eigen::Vector2d>& points, const Eigen::Vector2d& next) {
  constexpr double kJoint_m = 0.1, kLeastStep_m = 0.01;
  if (points.empty()) return false;
  const Eigen::Vector2d step = next - points.back();
  if (points.size() < 2 || step.norm() > kJoint_m) return step.norm() < kLeastStep_m;
  const Eigen::Vector2d along = points.back() - points[points.size() - 2];
  return step.dot(along.normalized()) < kLeastStep_m;
}

void append(std::vector<Eigen::Vector2d>& points, const geometry::Polyline& line, double from_m) {
  bool at_joint = true;
  const auto add = [&](const Eigen::Vector2d& point) {
    at_joint = at_joint && repeats_joint(points, point);
    if (!at_joint) points.push_back(point);
  };
  add(line.at(from_m));
  for (std::size_t i = 0; i < line.points().size(); ++i) {
    if (line.stations_m()[i] > from_m) add(line.points()[i]);
  }
}

/// All ways of one place, some of which may still be too short.
struct Growing {
  LanesAhead way;
  double covered_m = 0.0;
  bool has_ended = false;
};

}  // namespace

double turned_along_rad(const map::Lane& lane) {
  const double start = lane.pose_at(0.0).heading_rad;
  return std::abs(geometry::wrap_angle(lane.pose_at(lane.length_m()).heading_rad - start));
}

geometry::Polyline centre_of(const map::RoadMap& road_map, const LanesAhead& ahead) {
  std::vector<Eigen::Vector2d> points;
  double from_m = ahead.from_s_m;
  for (const map::LaneId lane : ahead.lanes) {
    append(points, road_map.lane(lane).centre.in_map, from_m);
    from_m = 0.0;
  }
  if (points.size() < 2) points.push_back(points.front());
  return geometry::Polyline(std::move(points));
}

geometry::Pose2 pose_on(const geometry::Polyline& way, double s_m) {
  const double within_m = std::clamp(s_m, 0.0, way.length_m());
  const geometry::Pose2 pose = way.pose_at(within_m);
  return within_m == s_m ? pose : pose * geometry::Pose2{s_m - within_m, 0.0, 0.0};
}

std::vector<LanesAhead> ways_ahead(const map::RoadMap& road_map, const map::LanePlace& from,
                                   double length_m, std::size_t most) {
  const auto length_of = [&](map::LaneId lane) {
    return road_map.lane(lane).centre.in_map.length_m();
  };
  std::vector<Growing> ways{
      {{{from.lane}, from.s_m}, std::max(0.0, length_of(from.lane) - from.s_m)}};
  for (std::size_t i = 0; i < ways.size();) {
    Growing& way = ways[i];
    const bool is_done = way.has_ended || way.covered_m >= length_m;
    if (is_done || way.way.lanes.size() >= kMostLanes) {
      ++i;
      continue;
    }
    const Growing before = way;
    const auto next = successors_by_turn(road_map, before.way.lanes.back());
    way.has_ended = next.empty();
    for (std::size_t k = 0; k < next.size() && (k == 0 || ways.size() < most); ++k) {
      Growing longer = before;
      longer.way.lanes.push_back(next[k]);
      longer.covered_m += length_of(next[k]);
      if (k == 0) ways[i] = std::move(longer);
      if (k > 0) ways.insert(ways.begin() + static_cast<std::ptrdiff_t>(i + k), std::move(longer));
    }
  }
  std::vector<LanesAhead> found;
  for (Growing& way : ways) found.push_back(std::move(way.way));
  return found;
}

std::optional<map::LaneId> straightest(const map::RoadMap& road_map, map::LaneId from) {
  const std::vector<map::LaneId> next = successors_by_turn(road_map, from);
  return next.empty() ? std::nullopt : std::optional(next.front());
}

geometry::Polyline straight_on(const map::RoadMap& road_map, const map::LanePlace& from,
                               double length_m) {
  return centre_of(road_map, ways_ahead(road_map, from, length_m, 1).front());
}

}  // namespace roadbed::planning::obstacles
