#include "roadbed/map/sumo/right_of_way.h"

#include <fmt/format.h>

#include <algorithm>
#include <numbers>
#include <set>

#include "roadbed/geometry/primitives/angle.h"
#include "roadbed/geometry/primitives/cross.h"
#include "roadbed/geometry/primitives/segment.h"
#include "roadbed/geometry/primitives/work_limit.h"
#include "roadbed/map/files/input_error.h"

namespace roadbed::map::sumo {
namespace {

constexpr double kLeft_rad = 5.0 * geometry::kRadiansPerDegree;
constexpr double kStraight_rad = 20.0 * geometry::kRadiansPerDegree;
constexpr double kOncoming_rad = 120.0 * geometry::kRadiansPerDegree;
constexpr double kTouch_m = 0.1;  // lanes that overlap by no more lie side by side

// At a share of the way, of which an edge may have but a part.
double heading_rad(const RoadMap& road_map, DirectedLane way, double share) {
  const Lane& lane = road_map.lane(way.lane);
  const double s_m = (way.against ? 1.0 - share : share) * lane.length_m();
  return lane.pose_at(s_m).heading_rad + (way.against ? std::numbers::pi : 0.0);
}

double heading_before_rad(const RoadMap& road_map, const Net& net, const NetConnection& one) {
  return heading_rad(road_map, net.from_lane(one), net.edges[one.from].to_share);
}

double heading_after_rad(const RoadMap& road_map, const Net& net, const NetConnection& one) {
  return heading_rad(road_map, net.to_lane(one), net.edges[one.to].from_share);
}

// Connections by the lanes that they leave or lie on.
std::vector<std::vector<std::uint32_t>> by_lane(const RoadMap& road_map, const Net& net) {
  std::vector<std::vector<std::uint32_t>> connections(road_map.lanes().size());
  for (std::uint32_t i = 0; i < net.connections.size(); ++i) {
    const NetConnection& connection = net.connections[i];
    connections[net.from_lane(connection).lane.index].push_back(i);
    for (const DirectedLane way : connection.across) connections[way.lane.index].push_back(i);
  }
  return connections;
}

}  // namespace

ConnectionConflicts::ConnectionConflicts(const Net& net, const std::vector<Conflict>& conflicts)
    : net_(net), at_nodes_(net.nodes.size()) {
  for (const Conflict& conflict : conflicts) {
    if (conflict.kind != ConflictKind::diverging) lanes_.emplace_back(conflict.one, conflict.other);
  }
  std::sort(lanes_.begin(), lanes_.end());
  for (std::uint32_t i = 0; i < net.connections.size(); ++i) {
    at_nodes_[net.edges[net.connections[i].from].to].push_back(i);
  }
}

bool ConnectionConflicts::meet(std::uint32_t a, std::uint32_t b) const {
  const NetConnection &one = net_.connections[a], &other = net_.connections[b];
  if (one.from == other.from && one.from_lane == other.from_lane) return false;
  if (one.to == other.to && one.to_lane == other.to_lane) return true;
  for (const DirectedLane way : one.across) {
    for (const DirectedLane beside : other.across) {
      if (way.lane == beside.lane) return true;
      const std::pair pair = std::minmax(way.lane, beside.lane);
      if (std::binary_search(lanes_.begin(), lanes_.end(),
                             std::pair<LaneId, LaneId>(pair.first, pair.second))) {
        return true;
      }
    }
  }
  return false;
}

namespace {

using Pairs = std::set<Prohibition>;

/// Counts pairs of connections: of many lanes that all meet in one place there are the square of
/// the square.
class PairBudget {
 public:
  explicit PairBudget(const RoadMap& road_map)
      : lanes_(road_map.lanes().size()), pairs_(geometry::most_steps(lanes_)) {}

  /// @throws InputError if there are more of them than a map of so many lanes may have.
  void spend(std::size_t pairs) {
    if (pairs_.spend(pairs)) return;
    throw InputError({.file = "SUMO",
                      .found = fmt::format("more than {} pairs of connections at nodes of {} lanes",
                                           geometry::most_steps(lanes_), lanes_),
                      .needed = "fewer lanes that all lead into one another",
                      .remedy = "clip the map to a part without them"});
  }

 private:
  std::size_t lanes_;
  geometry::WorkBudget pairs_;
};

void add_known(const RoadMap& road_map, const Net& net, const ConnectionConflicts& conflicts,
               PairBudget& budget, Pairs& found) {
  const auto connections = by_lane(road_map, net);
  for (const Regulation& regulation : road_map.regulations()) {
    if (regulation.type != "right_of_way") continue;
    std::vector<std::uint32_t> first, then;
    for (const RegulationMember& member : regulation.members) {
      if (!member.lane) continue;
      const auto& some = connections[member.lane->index];
      if (member.role == "right_of_way") first.insert(first.end(), some.begin(), some.end());
      if (member.role == "yield") then.insert(then.end(), some.begin(), some.end());
    }
    budget.spend(first.size() * then.size());
    for (const std::uint32_t a : first) {
      for (const std::uint32_t b : then) {
        const NetConnection &one = net.connections[a], &other = net.connections[b];
        if (net.edges[one.from].to != net.edges[other.from].to) continue;
        if (one.from == other.from || !conflicts.meet(a, b)) continue;
        found.insert({one.from, one.to, other.from, other.to});
      }
    }
  }
}

double apart_m(const geometry::Polyline& a, const geometry::Polyline& b) {
  double least_m = 1e300;
  const auto &of_a = a.points(), &of_b = b.points();
  for (std::size_t i = 1; i < of_a.size(); ++i) {
    for (std::size_t k = 1; k < of_b.size(); ++k) {
      const Eigen::Vector2d one = of_a[i] - of_a[i - 1], other = of_b[k] - of_b[k - 1];
      const Eigen::Vector2d gap = of_b[k - 1] - of_a[i - 1];
      const double across = geometry::cross(one, other);
      const double t = geometry::cross(gap, other) / across, u = geometry::cross(gap, one) / across;
      if (across != 0.0 && t >= 0.0 && t <= 1.0 && u >= 0.0 && u <= 1.0) return 0.0;
      least_m = std::min({least_m, geometry::distance_to_segment_m(of_a[i], of_b[k - 1], of_b[k]),
                          geometry::distance_to_segment_m(of_b[k], of_a[i - 1], of_a[i])});
    }
  }
  return least_m;
}

/// Finds turns across the oncoming traffic that meet others: SUMO takes it that they pass in front
/// of each other.
class CrossingTurns {
 public:
  CrossingTurns(const RoadMap& road_map, const Net& net, const LaneLines& lines)
      : road_map_(road_map), net_(net), lines_(lines) {
    if (net.left_hand) side_ = -1.0;
  }

  // Who turns less goes first, of equal ones that of the first edge.
  void add(const std::vector<std::uint32_t>& here, PairBudget& budget, Pairs& found) const {
    std::vector<Turn> turns;
    for (const std::uint32_t i : here) {
      const double angle_rad = side_ * turn_rad(road_map_, net_, net_.connections[i]);
      if (angle_rad > -kStraight_rad) turns.push_back({angle_rad, i});
    }
    budget.spend(turns.size() * turns.size() / 2);
    std::sort(turns.begin(), turns.end());
    for (std::size_t a = 0; a < turns.size(); ++a) {
      for (std::size_t b = a + 1; b < turns.size(); ++b) add(turns[a], turns[b], found);
    }
  }

 private:
  using Turn = std::pair<double, std::uint32_t>;

  void add(const Turn& first, const Turn& then, Pairs& found) const {
    const NetConnection& one = net_.connections[first.second];
    const NetConnection& other = net_.connections[then.second];
    if (one.from == other.from || one.to == other.to) return;
    const double between_rad = std::abs(geometry::wrap_angle(
        heading_before_rad(road_map_, net_, one) - heading_before_rad(road_map_, net_, other)));
    if (then.first <= kLeft_rad) return;  // neither turns across
    const bool both_cross = first.first > kLeft_rad;
    if (!both_cross && between_rad < kOncoming_rad) return;
    if (found.contains({one.from, one.to, other.from, other.to}) ||
        found.contains({other.from, other.to, one.from, one.to})) {
      return;
    }
    const double width_m = mean_width_m(road_map_.lane(net_.to_lane(one).lane)) +
                           mean_width_m(road_map_.lane(net_.to_lane(other).lane));
    if (apart_m(path(one), path(other)) > 0.5 * width_m - kTouch_m) return;
    found.insert({one.from, one.to, other.from, other.to});
  }

  geometry::Polyline path(const NetConnection& connection) const {
    std::vector<Eigen::Vector2d> points;
    for (const Eigen::Vector3d& point : lines_.of(connection)) points.push_back(point.head<2>());
    if (points.size() < 2) points.push_back(points.front());
    return geometry::Polyline(geometry::simplify(points, 0.2 * kTouch_m));
  }

  const RoadMap& road_map_;
  const Net& net_;
  const LaneLines& lines_;
  double side_ = 1.0;
};

}  // namespace

double turn_rad(const RoadMap& road_map, const Net& net, const NetConnection& connection) {
  return geometry::wrap_angle(heading_after_rad(road_map, net, connection) -
                              heading_before_rad(road_map, net, connection));
}

std::vector<Prohibition> find_prohibitions(const RoadMap& road_map, const Net& net,
                                           const LaneLines& lines,
                                           const ConnectionConflicts& conflicts) {
  PairBudget budget(road_map);
  Pairs known;
  add_known(road_map, net, conflicts, budget, known);
  Pairs found;
  for (const Prohibition& one : known) {
    if (!known.contains({one.then_from, one.then_to, one.first_from, one.first_to})) {
      found.insert(one);
    }
  }
  const CrossingTurns turns(road_map, net, lines);
  for (const auto& here : conflicts.at_nodes()) turns.add(here, budget, found);
  return {found.begin(), found.end()};
}

}  // namespace roadbed::map::sumo
