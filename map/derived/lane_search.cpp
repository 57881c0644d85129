#include "roadbed/map/derived/lane_search.h"

#include <algorithm>
#include <cmath>
#include <set>
#include <tuple>

#include "roadbed/geometry/primitives/cross.h"

namespace roadbed::map::inline derived {
namespace {

using Eigen::Vector2d;
using geometry::Ring;

/// Whether a segment has a point in the box: its part within each pair of sides (Liang, Barsky
/// 1984, doi:10.1145/357332.357333).
bool meets(const Vector2d& a, const Vector2d& b, const geometry::Box& box) {
  double from = 0.0, to = 1.0;
  for (int axis = 0; axis < 2; ++axis) {
    const double along = b[axis] - a[axis];
    if (along == 0.0) {
      if (a[axis] < box.min()[axis] || a[axis] > box.max()[axis]) return false;
      continue;
    }
    const double enters = (box.min()[axis] - a[axis]) / along;
    const double leaves = (box.max()[axis] - a[axis]) / along;
    from = std::max(from, std::min(enters, leaves));
    to = std::min(to, std::max(enters, leaves));
  }
  return from <= to;
}

bool meets(const Ring& ring, const geometry::Box& box) {
  for (std::size_t i = 0; i < ring.size(); ++i) {
    if (meets(ring[i], ring[(i + 1) % ring.size()], box)) return true;
  }
  return geometry::contains(ring, box.center());
}

/// Shares of the way at which it crosses the ring, in order, with both its ends.
std::vector<double> cuts(const Ring& ring, const Vector2d& from, const Vector2d& way) {
  std::vector<double> fractions{0.0, 1.0};
  for (std::size_t i = 0; i < ring.size(); ++i) {
    const Vector2d edge = ring[(i + 1) % ring.size()] - ring[i], to_edge = ring[i] - from;
    const double turn = geometry::cross(way, edge);
    if (turn == 0.0) continue;
    const double on_way = geometry::cross(to_edge, edge) / turn,
                 on_edge = geometry::cross(to_edge, way) / turn;
    if (on_way > 0.0 && on_way < 1.0 && on_edge >= 0.0 && on_edge <= 1.0)
      fractions.push_back(on_way);
  }
  std::sort(fractions.begin(), fractions.end());
  return fractions;
}

void add_passages(const Lane& lane, const Vector2d& from, const Vector2d& way,
                  std::vector<LaneOnRay>& passages) {
  const double length_m = way.norm();
  const std::vector<double> fractions = cuts(lane.polygon, from, way);
  bool goes_on = false;
  for (std::size_t i = 0; i + 1 < fractions.size(); ++i) {
    if (fractions[i] == fractions[i + 1]) continue;
    const double middle = 0.5 * (fractions[i] + fractions[i + 1]);
    const bool inside = geometry::contains(lane.polygon, from + middle * way);
    if (inside && goes_on) passages.back().to_m = fractions[i + 1] * length_m;
    if (inside && !goes_on) {
      passages.push_back({lane.id, fractions[i] * length_m, fractions[i + 1] * length_m});
    }
    goes_on = inside;
  }
}

}  // namespace

std::vector<LaneId> lanes_in_box(const RoadMap& road_map, const geometry::Box& box_in_map) {
  if (box_in_map.isEmpty()) return {};
  const double radius_m = 0.5 * box_in_map.diagonal().norm();
  std::vector<LaneId> lanes;
  for (const LaneMatch& near : road_map.locate(box_in_map.center(), radius_m, false)) {
    const LaneId id = near.place.lane;
    if (meets(road_map.lane(id).polygon, box_in_map)) lanes.push_back(id);
  }
  std::sort(lanes.begin(), lanes.end());
  return lanes;
}

std::vector<LaneOnRay> lanes_along_ray(const RoadMap& road_map, const Vector2d& from_in_map,
                                       double heading_rad, double length_m) {
  constexpr double kStep_m = 100.0;  // a long ray asks for the lanes near it step by step
  const Vector2d direction(std::cos(heading_rad), std::sin(heading_rad));
  std::set<LaneId> near;
  for (double at_m = 0.0; at_m < length_m; at_m += kStep_m) {
    const double step_m = std::min(kStep_m, length_m - at_m);
    const Vector2d middle = from_in_map + (at_m + 0.5 * step_m) * direction;
    for (const LaneMatch& match : road_map.locate(middle, 0.5 * step_m, false)) {
      near.insert(match.place.lane);
    }
  }
  std::vector<LaneOnRay> passages;
  for (const LaneId id : near) {
    add_passages(road_map.lane(id), from_in_map, length_m * direction, passages);
  }
  std::stable_sort(passages.begin(), passages.end(), [](const LaneOnRay& a, const LaneOnRay& b) {
    return std::tie(a.from_m, a.lane) < std::tie(b.from_m, b.lane);
  });
  return passages;
}

}  // namespace roadbed::map::derived
