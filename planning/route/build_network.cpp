#include "roadbed/planning/route/route_network.h"

#include <algorithm>
#include <cmath>

namespace roadbed::planning::inline route {
namespace {

using map::Lane;
using map::LaneId;

constexpr double kPiece_m = 5.0;
constexpr double kChord_m = 4.0;
constexpr double kLeastChord_m = 1.0;
constexpr double kStraight_per_m = 1e-3;  // slows nobody: 2 m/s² there are 45 m/s

// Of the circle through three points of the centreline, a chord apart; shorter chords would measure
// the file's rounding.
double curvature_at(const geometry::Polyline& line, double s_m) {
  const double chord_m = std::min(kChord_m, 0.5 * line.length_m());
  if (chord_m < kLeastChord_m || line.points().size() < 3) return 0.0;
  const double middle_m = std::clamp(s_m, chord_m, line.length_m() - chord_m);
  const Eigen::Vector2d b = line.at(middle_m), a = line.at(middle_m - chord_m) - b,
                        c = line.at(middle_m + chord_m) - b;
  const double sides = a.norm() * c.norm() * (c - a).norm();
  return sides > 0.0 ? 2.0 * std::abs(a.x() * c.y() - a.y() * c.x()) / sides : 0.0;
}

std::vector<double> piece_ends(const Lane& lane) {
  const double length_m = lane.length_m();
  std::vector<double> ends{length_m};
  if (lane.centre.in_map.points().size() > 2) {
    for (double s = kPiece_m; s < length_m; s += kPiece_m) ends.push_back(s);
  }
  for (const map::SpeedLimit& limit : lane.speed_limits) {
    if (limit.from_s_m > 0.0 && limit.from_s_m < length_m) ends.push_back(limit.from_s_m);
  }
  std::sort(ends.begin(), ends.end());
  ends.erase(std::unique(ends.begin(), ends.end()), ends.end());
  return ends;
}

void add_speeds(const Lane& lane, bool is_used, CsrLists<SpeedPiece>& speeds) {
  const std::size_t first = speeds.items.size();
  const auto& line = lane.centre.in_map;
  double from_m = 0.0, bend_before = 0.0;
  for (const double to_m : piece_ends(lane)) {
    // A chord reaches almost from one end of a piece to the other: the ends will do.
    const double bend = is_used ? curvature_at(line, to_m) : 0.0;
    const double worst = std::max(from_m > 0.0 ? bend_before : bend, bend);
    const SpeedPiece piece{to_m, lane.speed_limit_at_mps(from_m).value_or(0.0),
                           worst < kStraight_per_m ? 0.0 : worst};
    from_m = to_m;
    bend_before = bend;
    const bool joins = speeds.items.size() > first &&
                       speeds.items.back().limit_mps == piece.limit_mps &&
                       speeds.items.back().curvature_per_m == piece.curvature_per_m;
    if (joins) {
      speeds.items.back().to_s_m = to_m;
    } else {
      speeds.items.push_back(piece);
    }
  }
  speeds.end_list();
}

bool has_choice(const map::RoadMap& road_map, const Lane& lane) {
  if (lane.junction) return true;
  const auto& before = road_map.graph().of(lane.id).predecessors;
  return std::any_of(before.begin(), before.end(),
                     [&](LaneId from) { return road_map.graph().of(from).successors.size() > 1; });
}

Turn turn_of(const map::RoadMap& road_map, const Lane& lane) {
  return has_choice(road_map, lane) ? bend_of(lane) : Turn::none;
}

map::Participants users_of(const Lane& lane) {
  map::Participants users;
  for (int kind = 0; kind <= static_cast<int>(map::Participant::train); ++kind) {
    const auto participant = static_cast<map::Participant>(kind);
    if (may_use(lane, participant)) users.add(participant);
  }
  return users;
}

void add_links(const map::LaneLinks& links, const NetworkOptions& options,
               CsrLists<std::uint32_t>& successors) {
  std::vector<std::uint32_t> to;
  for (const LaneId next : links.successors) to.push_back(next.index);
  if (options.against_traffic) {
    for (const LaneId before : links.predecessors) to.push_back(before.index);
    for (const auto& beside : {links.left, links.right}) {
      if (beside && !beside->same_direction) to.push_back(beside->lane.index);
    }
  }
  std::sort(to.begin(), to.end());
  to.erase(std::unique(to.begin(), to.end()), to.end());
  successors.items.insert(successors.items.end(), to.begin(), to.end());
  successors.end_list();
}

void add_signals(const map::RoadMap& road_map, std::vector<NetworkLane>& lanes) {
  for (const map::Signal& signal : road_map.signals()) {
    if (!signal.dynamic) continue;
    for (std::size_t i = 0; i < signal.lanes.size(); ++i) {
      const LaneId lane = signal.lanes[i];
      lanes[lane.index].signal_s_m =
          i < signal.lane_s_m.size() ? signal.lane_s_m[i]
                                     : road_map.lane(lane).centre.in_map.project(signal.in_map).s_m;
    }
  }
}

}  // namespace

RouteNetwork make_route_network(const map::RoadMap& road_map, const NetworkOptions& options) {
  RouteNetwork network;
  network.lanes.reserve(road_map.lanes().size());
  for (const Lane& lane : road_map.lanes()) {
    const auto& points = lane.centre.in_map.points();
    NetworkLane made{.length_m = lane.length_m(),
                     .start_in_map = points.front(),
                     .end_in_map = points.back(),
                     .users = users_of(lane),
                     .type = lane.type,
                     .turn = turn_of(road_map, lane)};
    add_links(road_map.graph().of(lane.id), options, network.successors);
    add_speeds(lane, !made.users.empty(), network.speeds);
    network.lanes.push_back(made);
  }
  add_signals(road_map, network.lanes);
  add_contraflow_lanes(road_map, options, network);
  add_neighbours(road_map, options, network);
  return network;
}

}  // namespace roadbed::planning::route
