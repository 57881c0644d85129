#include <algorithm>
#include <limits>
#include <queue>
#include <tuple>

#include "roadbed/map/sumo/net.h"

namespace roadbed::map::sumo {
namespace {

constexpr double kChange_m = 10.0;  // what a lane change is worth

struct LanePlaceInNet {
  std::uint32_t edge = 0, lane = 0;
};

class ConnectionMaker {
 public:
  ConnectionMaker(const RoadMap& road_map, const DirectedLanes& ways,
                  const std::vector<std::optional<std::uint32_t>>& inner,
                  const std::vector<NetEdge>& edges)
      : road_map_(road_map), ways_(ways), inner_(inner), edges_(edges) {
    for (std::uint32_t edge = 0; edge < edges.size(); ++edge) {
      for (std::uint32_t lane = 0; lane < edges[edge].lanes.size(); ++lane) {
        places_.emplace(edges[edge].lanes[lane], LanePlaceInNet{edge, lane});
      }
    }
  }

  std::vector<NetConnection> make() {
    for (std::uint32_t edge = 0; edge < edges_.size(); ++edge) {
      for (std::uint32_t lane = 0; lane < edges_[edge].lanes.size(); ++lane) {
        lead_from({edge, lane});
      }
    }
    return std::move(connections_);
  }

 private:
  struct Step {
    double length_m = 0.0;
    DirectedLane before;
    Participants users;
    bool is_change = false;  // to the lane beside the one before
  };

  using Open = std::pair<double, DirectedLane>;
  using Queue = std::priority_queue<Open, std::vector<Open>, std::greater<>>;

  // To the lanes beside one inside the junction.
  void change_lane(DirectedLane from, double length_m, Participants users,
                   std::map<DirectedLane, Step>& steps, Queue& open) const {
    const LaneLinks& links = road_map_.graph().of(from.lane);
    for (const auto* beside : {&links.left, &links.right}) {
      if (from.against || !*beside || !(*beside)->same_direction) continue;
      const DirectedLane next{(*beside)->lane, false};
      const Participants through = both(users, ways_.users(next));
      if (!(*beside)->change_allowed() || through.empty() || !inner_[next.lane.index]) continue;
      const auto found = steps.find(next);
      if (found != steps.end() && found->second.length_m <= length_m) continue;
      steps[next] = {length_m, from, through, true};
      open.emplace(length_m, next);
    }
  }

  // Dijkstra over the lanes inside the junction.
  void lead_from(LanePlaceInNet start) {
    const DirectedLane first = edges_[start.edge].lanes[start.lane];
    std::map<DirectedLane, Step> steps;
    std::map<DirectedLane, Step> reached;  // lanes of edges
    Queue open;
    const auto look = [&](DirectedLane from, double length_m, Participants users) {
      for (const DirectedLane next : ways_.next(from)) {
        const Participants through = both(users, ways_.users(next));
        if (through.empty()) continue;
        const bool is_inner = inner_[next.lane.index].has_value();
        auto& known = is_inner ? steps : reached;
        const auto found = known.find(next);
        if (found != known.end() && found->second.length_m <= length_m) continue;
        known[next] = {length_m, from, through};
        if (is_inner) open.emplace(length_m, next);
      }
    };
    // An edge that is the begin of a lane inside goes on along it.
    const bool is_inside = inner_[first.lane.index].has_value();
    if (is_inside) {
      steps[first] = {0.0, first, ways_.users(first)};
      open.emplace(0.0, first);
    } else {
      look(first, 0.0, ways_.users(first));
    }
    while (!open.empty()) {
      const auto [length_m, way] = open.top();
      open.pop();
      const Step step = steps.at(way);
      if (step.length_m < length_m) continue;
      look(way, length_m + road_map_.lane(way.lane).length_m(), step.users);
      change_lane(way, length_m + kChange_m, step.users, steps, open);
      if (ways_.next(way).empty())
        reached[way] = {length_m, way, step.users};  // its end is an edge
    }
    for (const auto& [way, last] : reached) {
      const auto place = places_.find(way);
      if (place == places_.end()) continue;
      NetConnection connection{start.edge, place->second.edge, start.lane, place->second.lane, {},
                               false,      last.users};
      bool is_left = false;  // the lane is left for the one after it, which stands for both
      for (DirectedLane at = last.before; at != first; at = steps.at(at).before) {
        if (!is_left) connection.across.insert(connection.across.begin(), at);
        is_left = steps.at(at).is_change;
        connection.has_change = connection.has_change || is_left;
      }
      if (is_inside && !is_left) connection.across.insert(connection.across.begin(), first);
      connections_.push_back(std::move(connection));
    }
  }

  const RoadMap& road_map_;
  const DirectedLanes& ways_;
  const std::vector<std::optional<std::uint32_t>>& inner_;
  const std::vector<NetEdge>& edges_;
  std::map<DirectedLane, LanePlaceInNet> places_;
  std::vector<NetConnection> connections_;
};

}  // namespace

std::vector<NetConnection> make_connections(const RoadMap& road_map, const DirectedLanes& ways,
                                            const std::vector<std::optional<std::uint32_t>>& inner,
                                            const std::vector<NetEdge>& edges) {
  return ConnectionMaker(road_map, ways, inner, edges).make();
}

}  // namespace roadbed::map::sumo
