#include "roadbed/map/derived/surface.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <optional>

#include "roadbed/geometry/primitives/work_limit.h"
#include "roadbed/map/derived/crowded.h"

namespace roadbed::map::inline derived {
namespace {

using geometry::Polygon;
using geometry::Ring;

/// Lanes in order of id.
using LaneSet = std::vector<LaneId>;

bool is_among(LaneId id, const LaneSet& lanes) {
  return std::binary_search(lanes.begin(), lanes.end(), id);
}

bool is_beside(const RoadMap& road_map, const Lane& lane, const std::optional<Neighbour>& other) {
  if (!other) return false;
  const Lane& neighbour = road_map.lane(other->lane);
  return neighbour.road == lane.road && neighbour.origin.section == lane.origin.section;
}

/// Lanes of one section in one driving direction, from the leftmost to the right.
struct Strip {
  std::vector<LaneId> lanes;
};

/// Cuts the wanted lanes into strips, each lane in one.
class StripCutter {
 public:
  StripCutter(const RoadMap& road_map, std::span<const LaneId> wanted)
      : road_map_(road_map), wanted_(wanted.begin(), wanted.end()) {
    std::sort(wanted_.begin(), wanted_.end());
    wanted_.erase(std::unique(wanted_.begin(), wanted_.end()), wanted_.end());
    taken_.assign(wanted_.size(), false);
  }

  std::vector<Strip> strips() {
    std::vector<Strip> strips;
    for (const bool only_leftmost : {true, false}) {  // the second pass: neighbours in a circle
      for (const LaneId id : wanted_) {
        if (is_taken(id) || (only_leftmost && !is_leftmost(id))) continue;
        strips.push_back(take(id));
      }
    }
    return strips;
  }

 private:
  std::vector<bool>::reference taken(LaneId id) {
    const auto place = std::lower_bound(wanted_.begin(), wanted_.end(), id) - wanted_.begin();
    return taken_[static_cast<std::size_t>(place)];
  }
  bool is_taken(LaneId id) { return !is_among(id, wanted_) || taken(id); }

  bool is_leftmost(LaneId id) const {
    const std::optional<Neighbour>& left = road_map_.graph().of(id).left;
    return !is_beside(road_map_, road_map_.lane(id), left) || !left->same_direction ||
           !is_among(left->lane, wanted_);
  }

  /// The lane and those to its right, as far as they are left to take.
  Strip take(LaneId leftmost) {
    Strip strip;
    for (LaneId id = leftmost;;) {
      strip.lanes.push_back(id);
      taken(id) = true;
      const std::optional<Neighbour>& right = road_map_.graph().of(id).right;
      if (!is_beside(road_map_, road_map_.lane(id), right) || !right->same_direction) return strip;
      if (is_taken(right->lane)) return strip;
      id = right->lane;
    }
  }

  const RoadMap& road_map_;
  LaneSet wanted_;
  std::vector<bool> taken_;
};

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

template <typename Wants>
std::vector<LaneId> lanes_where(const RoadMap& road_map, const Wants& wants) {
  std::vector<LaneId> wanted;
  for (const Lane& lane : road_map.lanes()) {
    if (wants(lane)) wanted.push_back(lane.id);
  }
  return wanted;
}

}  // namespace

Surface surface_of(std::span<const Polygon> polygons, const SurfaceOptions& options) {
  try {
    geometry::United united = geometry::unite_and_report(polygons, options.weld_m);
    return {std::move(united.polygons), united.moved_points, united.most_moved_m};
  } catch (const geometry::TooMuchWork& error) {
    refuse_crowded("surface", error.what());
  }
}

Surface lanes_surface(const RoadMap& road_map, std::span<const LaneId> lanes,
                      const SurfaceOptions& options) {
  std::vector<Polygon> polygons;
  for (const Strip& strip : StripCutter(road_map, lanes).strips()) {
    if (std::optional<Polygon> whole = merged(road_map, strip)) {
      polygons.push_back(std::move(*whole));
      continue;
    }
    for (const LaneId id : strip.lanes) {
      if (road_map.lane(id).polygon.size() > 2) polygons.push_back({road_map.lane(id).polygon, {}});
    }
  }
  return surface_of(polygons, options);
}

std::vector<LaneId> drivable_lanes(const RoadMap& road_map) {
  return lanes_where(road_map, [](const Lane& lane) { return is_drivable(lane.type); });
}

std::vector<LaneId> drivable_lanes(const RoadMap& road_map, JunctionId junction) {
  std::vector<LaneId> lanes;
  for (const RoadId road : road_map.junction(junction).connecting_roads) {
    for (const LaneId id : road_map.road(road).lanes) {
      const Lane& lane = road_map.lane(id);
      if (lane.junction == junction && is_drivable(lane.type)) lanes.push_back(id);
    }
  }
  std::sort(lanes.begin(), lanes.end());
  return lanes;
}

std::vector<Polygon> road_surface(const RoadMap& road_map, RoadId road,
                                  const SurfaceOptions& options) {
  return lanes_surface(road_map, road_map.road(road).lanes, options).polygons;
}

std::vector<Polygon> junction_surface(const RoadMap& road_map, JunctionId junction,
                                      const SurfaceOptions& options) {
  return lanes_surface(road_map, drivable_lanes(road_map, junction), options).polygons;
}

std::vector<Polygon> drivable_surface(const RoadMap& road_map, const SurfaceOptions& options) {
  return lanes_surface(road_map, drivable_lanes(road_map), options).polygons;
}

std::vector<geometry::Polygon> road_area_surface(const RoadMap& road_map,
                                                 const SurfaceOptions& options) {
  std::vector<geometry::Polygon> polygons;
  for (const Area& area : road_map.areas()) {
    if (area.is_road) polygons.insert(polygons.end(), area.in_map.begin(), area.in_map.end());
  }
  return surface_of(polygons, options).polygons;
}

std::vector<geometry::MedialBranch> road_centrelines(const RoadMap& road_map,
                                                     const SurfaceOptions& options) {
  std::vector<geometry::MedialBranch> branches;
  for (const geometry::Polygon& polygon : road_area_surface(road_map, options)) {
    auto found = geometry::medial_axis(polygon);
    branches.insert(branches.end(), std::make_move_iterator(found.begin()),
                    std::make_move_iterator(found.end()));
  }
  return branches;
}

}  // namespace roadbed::map::derived
