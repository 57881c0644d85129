#include "roadbed/map/surface.h"

#include <cmath>
#include <optional>

namespace roadbed::map {
namespace {

using geometry::Polygon;
using geometry::Ring;

/// Lanes as yes or no, one per lane of the map.
using LaneSet = std::vector<bool>;

bool is_beside(const RoadMap& road_map, const Lane& lane, const std::optional<Neighbour>& other) {
  if (!other) return false;
  const Lane& neighbour = road_map.lane(other->lane);
  return neighbour.road == lane.road && neighbour.origin.section == lane.origin.section;
}

/// Lanes of one section in one driving direction, from the leftmost to the right.
struct Strip {
  std::vector<LaneId> lanes;
};

/// The lane and those to its right, as far as they are left to take; takes them.
Strip take_strip(const RoadMap& road_map, LaneId leftmost, LaneSet& left_to_take) {
  Strip strip;
  for (LaneId id = leftmost;;) {
    strip.lanes.push_back(id);
    left_to_take[id.index] = false;
    const std::optional<Neighbour>& right = road_map.graph().of(id).right;
    if (!is_beside(road_map, road_map.lane(id), right) || !right->same_direction) return strip;
    if (!left_to_take[right->lane.index]) return strip;
    id = right->lane;
  }
}

bool is_leftmost(const RoadMap& road_map, LaneId id, const LaneSet& wanted) {
  const std::optional<Neighbour>& left = road_map.graph().of(id).left;
  return !is_beside(road_map, road_map.lane(id), left) || !left->same_direction ||
         !wanted[left->lane.index];
}

std::vector<Strip> strips_of(const RoadMap& road_map, const LaneSet& wanted) {
  LaneSet left_to_take = wanted;
  std::vector<Strip> strips;
  for (const bool only_leftmost : {true, false}) {  // the second pass: neighbours in a circle
    for (const Lane& lane : road_map.lanes()) {
      if (!left_to_take[lane.id.index]) continue;
      if (only_leftmost && !is_leftmost(road_map, lane.id, wanted)) continue;
      strips.push_back(take_strip(road_map, lane.id, left_to_take));
    }
  }
  return strips;
}

/// Left border of the first lane, then the right border of the last one backwards.
Ring outline(const RoadMap& road_map, const Strip& strip) {
  const auto& left = road_map.lane(strip.lanes.front()).left.in_map.points();
  const auto& right = road_map.lane(strip.lanes.back()).right.in_map.points();
  Ring ring(right.begin(), right.end());
  ring.insert(ring.end(), left.rbegin(), left.rend());
  return ring;
}

/// The strip as one polygon: five times less work for the union than lane by lane. None where its
/// outline folds, or encloses another area than its lanes do (they do not share their borders).
std::optional<Polygon> merged(const RoadMap& road_map, const Strip& strip) {
  const auto pieces = geometry::make_simple(outline(road_map, strip));
  if (pieces.size() != 1 || !pieces.front().holes.empty()) return std::nullopt;
  double lanes_m2 = 0.0;
  for (const LaneId id : strip.lanes) {
    lanes_m2 += std::abs(geometry::signed_area_m2(road_map.lane(id).polygon));
  }
  constexpr double kSampling = 2e-3;  // [m] borders of neighbours may be sampled differently
  const double tolerance_m2 = kSampling * geometry::perimeter_m(pieces.front().outer);
  if (std::abs(geometry::area_m2(pieces.front()) - lanes_m2) > tolerance_m2) return std::nullopt;
  return pieces.front();
}

std::vector<Polygon> surface(const RoadMap& road_map, const LaneSet& wanted,
                             const SurfaceOptions& options) {
  std::vector<Polygon> polygons;
  for (const Strip& strip : strips_of(road_map, wanted)) {
    if (std::optional<Polygon> whole = merged(road_map, strip)) {
      polygons.push_back(std::move(*whole));
      continue;
    }
    for (const LaneId id : strip.lanes) {
      if (road_map.lane(id).polygon.size() > 2) polygons.push_back({road_map.lane(id).polygon, {}});
    }
  }
  return geometry::unite(polygons, options.weld_m);
}

template <typename Wants>
LaneSet lanes_where(const RoadMap& road_map, const Wants& wants) {
  LaneSet wanted(road_map.lanes().size());
  for (const Lane& lane : road_map.lanes()) wanted[lane.id.index] = wants(lane);
  return wanted;
}

}  // namespace

std::vector<Polygon> road_surface(const RoadMap& road_map, RoadId road,
                                  const SurfaceOptions& options) {
  LaneSet wanted(road_map.lanes().size());
  for (const LaneId id : road_map.road(road).lanes) wanted[id.index] = true;
  return surface(road_map, wanted, options);
}

std::vector<Polygon> junction_surface(const RoadMap& road_map, JunctionId junction,
                                      const SurfaceOptions& options) {
  const auto wants = [&](const Lane& lane) {
    return lane.junction == junction && is_drivable(lane.type);
  };
  return surface(road_map, lanes_where(road_map, wants), options);
}

std::vector<Polygon> drivable_surface(const RoadMap& road_map, const SurfaceOptions& options) {
  const auto wants = [](const Lane& lane) { return is_drivable(lane.type); };
  return surface(road_map, lanes_where(road_map, wants), options);
}

}  // namespace roadbed::map
