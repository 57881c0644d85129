#include "roadbed/map/sumo/directed_lanes.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "roadbed/geometry/polygons/polygon.h"
#include "roadbed/map/sumo/lane_users.h"

namespace roadbed::map::sumo {
namespace {

constexpr double kLeastLength_m = 0.05, kLeastWidth_m = 0.2;
constexpr double kCorner_m = 0.05;  // how far apart corners of lanes that meet may be

/// The corners of a lane's end, as its driver sees them.
struct Gate {
  Eigen::Vector2d left, right;
  DirectedLane way;
};

Gate gate(const RoadMap& road_map, DirectedLane way, bool at_end) {
  const Lane& lane = road_map.lane(way.lane);
  const auto corner = [&](const LaneLine& line) {
    return at_end != way.against ? line.in_map.points().back() : line.in_map.points().front();
  };
  const Eigen::Vector2d left = corner(lane.left), right = corner(lane.right);
  return way.against ? Gate{right, left, way} : Gate{left, right, way};
}

// Those of people on foot are open in both directions in SUMO anyway.
Participants users_against(const Lane& lane, Participants users) {
  if (lane.one_way) return {};
  Participants riders = users;
  riders.remove(Participant::pedestrian);
  return riders;
}

}  // namespace

Participants both(Participants a, Participants b) {
  return Participants::from_bits(static_cast<std::uint16_t>(a.bits() & b.bits()));
}

double mean_width_m(const Lane& lane) {
  return geometry::signed_area_m2(lane.polygon) / std::max(1e-3, lane.length_m());
}

DirectedLanes::DirectedLanes(const RoadMap& road_map) {
  const std::size_t count = road_map.lanes().size();
  users_.resize(2 * count);
  next_.resize(2 * count);
  before_.resize(2 * count);
  for (const Lane& lane : road_map.lanes()) {
    if (lane.length_m() < kLeastLength_m || mean_width_m(lane) < kLeastWidth_m) continue;
    users_[place({lane.id, false})] = users_of(lane);
    users_[place({lane.id, true})] = users_against(lane, users_of(lane));
  }
  for (std::uint32_t i = 0; i < count; ++i) {
    const LaneLinks& links = road_map.graph().of({i});
    for (const LaneId after : links.successors) lead({{i}, false}, {after, false});
    for (const LaneId before : links.predecessors) lead({{i}, true}, {before, true});
  }
  join_corners(road_map);
}

void DirectedLanes::lead(DirectedLane from, DirectedLane to) {
  if (both(users(from), users(to)).empty()) return;
  std::vector<DirectedLane>& list = next_[place(from)];
  if (std::find(list.begin(), list.end(), to) != list.end()) return;
  list.push_back(to);
  before_[place(to)].push_back(from);
}

// From lanes driven one way into such as are driven the other way: the map links their borders
// only.
void DirectedLanes::join_corners(const RoadMap& road_map) {
  const auto cell = [](double x_m) { return static_cast<long long>(std::floor(x_m)); };
  std::multimap<std::pair<long long, long long>, Gate> entries;
  bool has_contraflow = false;
  for (const Lane& lane : road_map.lanes()) {
    for (const bool against : {false, true}) {
      if (!has({lane.id, against})) continue;
      has_contraflow = has_contraflow || against;
      const Gate entry = gate(road_map, {lane.id, against}, false);
      entries.emplace(std::pair(cell(entry.left.x()), cell(entry.left.y())), entry);
    }
  }
  if (!has_contraflow) return;
  const auto join = [&](const Gate& exit, const Gate& entry) {
    const bool meet = (exit.left - entry.left).norm() <= kCorner_m &&
                      (exit.right - entry.right).norm() <= kCorner_m;
    if (meet && entry.way.against != exit.way.against && entry.way.lane != exit.way.lane) {
      lead(exit.way, entry.way);
    }
  };
  for (const Lane& lane : road_map.lanes()) {
    for (const bool against : {false, true}) {
      if (!has({lane.id, against})) continue;
      const Gate exit = gate(road_map, {lane.id, against}, true);
      if ((exit.left - exit.right).norm() <= 2.0 * kCorner_m) continue;
      for (long long x = cell(exit.left.x() - kCorner_m); x <= cell(exit.left.x() + kCorner_m);
           ++x) {
        for (long long y = cell(exit.left.y() - kCorner_m); y <= cell(exit.left.y() + kCorner_m);
             ++y) {
          const auto [from, to] = entries.equal_range({x, y});
          for (auto entry = from; entry != to; ++entry) join(exit, entry->second);
        }
      }
    }
  }
}

}  // namespace roadbed::map::sumo
