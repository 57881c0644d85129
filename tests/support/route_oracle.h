#pragma once

#include <algorithm>
#include <boost/graph/adjacency_list.hpp>
#include <boost/graph/dijkstra_shortest_paths.hpp>
#include <limits>
#include <optional>
#include <utility>
#include <vector>

#include "roadbed/map/model/road_map.h"
#include "roadbed/planning/route/route_options.h"

namespace roadbed::tests {

/// The documented rules as a plain graph, solved by Boost: each lane has an entry, at which changes
/// may still be made, and an exit, at which the rest of it is driven. Markings are all or nothing.
class RouteOracle {
 public:
  RouteOracle(const map::RoadMap& road_map, const planning::RouteOptions& options)
      : road_map_(road_map), options_(options) {}

  double cost(const map::LanePlace& from, const map::LanePlace& to) const {
    const std::size_t lanes = road_map_.lanes().size(), start = 2 * lanes, goal = start + 1;
    Graph graph(goal + 1);
    for (const map::Lane& lane : road_map_.lanes()) {
      if (!usable(lane.id)) continue;
      for (const auto& [last, price] : changes(lane.id, 1.0)) {
        add_edge(lane.id.index, lanes + last.index, price, graph);
        if (last != to.lane) continue;
        const double end = to.s_m / road_map_.lane(last).length_m();
        for (const auto& [same, at_goal] : changes(lane.id, end)) {
          if (same == last) add_edge(lane.id.index, goal, at_goal + travel(last, 0, end), graph);
        }
      }
      for (const map::LaneId next : road_map_.graph().of(lane.id).successors) {
        if (usable(next)) add_edge(lanes + lane.id.index, next.index, travel(lane.id, 0, 1), graph);
      }
    }
    const double begin = from.s_m / road_map_.lane(from.lane).length_m();
    const double end = to.s_m / road_map_.lane(to.lane).length_m();
    for (const map::Lane& lane : road_map_.lanes()) {
      if (!usable(lane.id)) continue;
      for (const bool at_start : {false, true}) {
        if (at_start && lane.id != from.lane) continue;
        const std::size_t node = at_start ? start : lane.id.index;
        for_each_span(lane.id, [&](const Span& span) {
          const map::LaneId last = span.back().back();
          if (const auto price = price_of(span, at_start ? begin : 0.0, 1.0)) {
            add_edge(node, lanes + last.index, *price - travel(last, 0, 1), graph);
          }
          if (last != to.lane) return;
          const auto price = price_of(span, at_start ? begin : 0.0, end);
          if (price) add_edge(node, goal, *price, graph);
        });
      }
    }
    for (const auto& [last, price] : changes(from.lane, 1.0 - begin)) {
      for (const map::LaneId next : road_map_.graph().of(last).successors) {
        if (usable(next)) add_edge(start, next.index, price + travel(last, begin, 1.0), graph);
      }
    }
    if (begin <= end) {
      for (const auto& [last, price] : changes(from.lane, end - begin)) {
        if (last == to.lane) add_edge(start, goal, price + travel(last, begin, end), graph);
      }
    }
    std::vector<double> distance(goal + 1);
    boost::dijkstra_shortest_paths(
        graph, start,
        boost::distance_map(distance.data()).distance_inf(std::numeric_limits<double>::infinity()));
    return distance[goal];
  }

 private:
  using Graph =
      boost::adjacency_list<boost::vecS, boost::vecS, boost::directedS, boost::no_property,
                            boost::property<boost::edge_weight_t, double>>;

  bool usable(map::LaneId lane) const {
    const bool closed =
        std::find(options_.avoid.begin(), options_.avoid.end(), lane) != options_.avoid.end();
    return map::is_drivable(road_map_.lane(lane).type) && !closed;
  }

  double travel(map::LaneId id, double begin, double end) const {
    const map::Lane& lane = road_map_.lane(id);
    const double from_m = begin * lane.length_m(), to_m = end * lane.length_m();
    if (options_.cost == planning::RouteCost::distance) return to_m - from_m;
    double time_s = 0.0;
    for (std::size_t i = 0; i <= lane.speed_limits.size(); ++i) {
      const double first_m = i == 0 ? 0.0 : lane.speed_limits[i - 1].from_s_m;
      const double last_m =
          i < lane.speed_limits.size() ? lane.speed_limits[i].from_s_m : lane.length_m();
      const double part_m = std::min(to_m, last_m) - std::max(from_m, first_m);
      if (part_m <= 0.0) continue;
      const auto limit = i == 0 ? std::nullopt : lane.speed_limits[i - 1].limit_mps;
      time_s +=
          part_m / std::min(limit && *limit > 0.0 ? *limit : planning::default_speed_mps(lane.type),
                            options_.max_speed_mps);
    }
    return time_s;
  }

  // Changes beside several lane groups: of each lane group the lanes from the one that is left on.
  using Span = std::vector<std::vector<map::LaneId>>;

  template <typename Visit>
  void for_each_span(map::LaneId lane, const Visit& visit) const {
    for (const bool leftwards : {true, false}) {
      for (std::size_t count = 1; count <= 3; ++count) {
        const auto lanes = beside(lane, leftwards, count);
        if (!lanes.empty()) lengthen({lanes}, leftwards, visit);
      }
    }
  }

  std::vector<map::LaneId> beside(map::LaneId lane, bool leftwards, std::size_t count) const {
    std::vector<map::LaneId> lanes{lane};
    while (lanes.size() <= count) {
      const auto next = changed_to(lanes.back(), leftwards);
      if (!next) return {};
      lanes.push_back(*next);
    }
    return lanes;
  }

  template <typename Visit>
  void lengthen(const Span& span, bool leftwards, const Visit& visit) const {
    if (span.size() > 18) return;
    for (const map::LaneId next : road_map_.graph().of(span.back().front()).successors) {
      const auto lanes = beside(next, leftwards, span.front().size() - 1);
      bool follows = !lanes.empty();
      for (std::size_t i = 0; i < lanes.size(); ++i) {
        const auto& ahead = road_map_.graph().of(span.back()[i]).successors;
        follows = follows && std::count(ahead.begin(), ahead.end(), lanes[i]) > 0;
      }
      if (!follows) continue;
      Span longer = span;
      longer.push_back(lanes);
      visit(longer);
      lengthen(longer, leftwards, visit);
    }
  }

  std::optional<map::LaneId> changed_to(map::LaneId lane, bool leftwards) const {
    const map::LaneLinks& links = road_map_.graph().of(lane);
    const auto& next = leftwards ? links.left : links.right;
    const bool may = next && next->same_direction && next->change_allowed();
    return may ? std::optional(next->lane) : std::nullopt;
  }

  // The way from a share of the first lane group to one of the last, and the changes on it; none if
  // there is too little room, or one lane group fewer has enough of it; several only where neither
  // the first nor the last lane group has enough for one.
  std::optional<double> price_of(const Span& span, double begin, double end) const {
    std::vector<double> parts_m;
    double all_m = 0.0;
    for (std::size_t i = 0; i < span.size(); ++i) {
      for (const map::LaneId lane : span[i]) {
        if (!usable(lane)) return {};
      }
      const double fraction = (i + 1 == span.size() ? end : 1.0) - (i == 0 ? begin : 0.0);
      parts_m.push_back(fraction * road_map_.lane(span[i].front()).length_m());
      all_m += parts_m.back();
    }
    const std::size_t changes = span.front().size() - 1;
    const double count = static_cast<double>(changes), room_m = all_m / count;
    const double alone_m =
        std::max(options_.comfortable_lane_change_m, options_.least_lane_change_m);
    if (changes > 1 && (parts_m.front() >= alone_m || parts_m.back() >= alone_m)) return {};
    const double enough_m = count * alone_m;
    if (parts_m.front() < 0.1 || parts_m.back() < 0.1) return {};
    if (room_m < options_.least_lane_change_m) return {};
    if (all_m - parts_m.front() >= enough_m || all_m - parts_m.back() >= enough_m) return {};
    const double price = options_.cost == planning::RouteCost::distance
                             ? options_.prices_m.lane_change
                             : options_.prices_s.lane_change;
    double cost = count * price * std::max(1.0, options_.comfortable_lane_change_m / room_m);
    double done_m = 0.0;
    for (std::size_t i = 0; i < span.size(); ++i) {
      done_m += parts_m[i];
      std::size_t made = 0;
      while (made < changes && (static_cast<double>(made) + 0.5) * room_m <= done_m + 1e-9) ++made;
      cost += travel(span[i][made], i == 0 ? begin : 0.0, i + 1 == span.size() ? end : 1.0);
    }
    return cost;
  }

  // Lanes that a chain of changes leads to within a share of the lane group, and what it costs.
  std::vector<std::pair<map::LaneId, double>> changes(map::LaneId from, double fraction) const {
    std::vector<std::pair<map::LaneId, double>> reached{{from, 0.0}};
    for (const bool leftwards : {true, false}) {
      double least_m = std::numeric_limits<double>::infinity();
      map::LaneId lane = from;
      for (int count = 1;; ++count) {
        const map::LaneLinks& links = road_map_.graph().of(lane);
        const auto& next = leftwards ? links.left : links.right;
        if (!next || !next->same_direction || !next->change_allowed() || !usable(next->lane)) break;
        least_m = std::min(least_m, fraction * road_map_.lane(lane).length_m());
        const double room_m = least_m / count;
        if (room_m < options_.least_lane_change_m - 1e-9) break;
        const double price = options_.cost == planning::RouteCost::distance
                                 ? options_.prices_m.lane_change
                                 : options_.prices_s.lane_change;
        lane = next->lane;
        reached.push_back(
            {lane, count * price * std::max(1.0, options_.comfortable_lane_change_m / room_m)});
      }
    }
    return reached;
  }

  const map::RoadMap& road_map_;
  const planning::RouteOptions& options_;
};

}  // namespace roadbed::tests
