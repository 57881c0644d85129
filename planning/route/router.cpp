#include "roadbed/planning/route/router.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <stdexcept>

#include "roadbed/planning/route/route_network.h"
#include "roadbed/planning/route/route_solver.h"

namespace roadbed::planning::inline route {
namespace {

constexpr double kStationSlack_m = 1e-6;

void check_on_lane(const map::RoadMap& road_map, const map::LanePlace& place) {
  if (place.lane.index >= road_map.lanes().size()) {
    throw std::invalid_argument("Router: a place names no lane of the map");
  }
  const map::Lane& lane = road_map.lane(place.lane);
  if (!(place.s_m >= -kStationSlack_m && place.s_m <= lane.length_m() + kStationSlack_m)) {
    throw std::invalid_argument(fmt::format("Router: a place is at {} m of lane {}, {} m long",
                                            place.s_m, lane.name, lane.length_m()));
  }
}

void check(const map::RoadMap& road_map, const RoutePlace& place) {
  for (const RoutePlace& one : each_lane_of(place)) check_on_lane(road_map, one);
}

void check(const map::RoadMap& road_map, const BlockedStretch& stretch) {
  if (stretch.lane.index >= road_map.lanes().size()) {
    throw std::invalid_argument("Router: a blocked lane is not in the map");
  }
  const auto [from_s_m, to_s_m] = stretch.stations;
  if (!(from_s_m <= to_s_m)) {
    throw std::invalid_argument(
        fmt::format("Router: lane {} is blocked from {} m to {} m, which is no stretch",
                    road_map.lane(stretch.lane).name, from_s_m, to_s_m));
  }
}

bool knows_limit(const RouteNetwork& network, std::uint32_t lane) {
  const auto pieces = network.speeds.of(lane);
  return std::all_of(pieces.begin(), pieces.end(),
                     [](const SpeedPiece& piece) { return piece.limit_mps > 0.0; });
}

// Of what a change has of the lane group itself.
double middle_inside(const FractionRange& range) {
  return std::midpoint(std::max(0.0, range.from), std::min(1.0, range.to));
}

/// Lays lane groups behind one another as legs, priced by both measures.
class Assembly {
 public:
  /// @param limit_known  of each lane of the network.
  Assembly(const RoutingCostModel& time, const RoutingCostModel& distance,
           const std::vector<bool>& limit_known, std::size_t lane_groups)
      : network_(time.network()), time_(time), distance_(distance), limit_known_(limit_known) {
    route_.legs.reserve(lane_groups + lane_groups / 4);
  }

  void add(const LaneGroup& lane_group, bool is_first) {
    double from = lane_group.range.from;
    for (std::size_t i = 0; i < lane_group.chain.size(); ++i) {
      const bool changes = i + 1 < lane_group.chain.size();
      const double to = changes ? middle_inside(lane_group.changes.ranges[i]) : lane_group.range.to;
      route_.legs.push_back(leg(lane_group, i, {from, to}));
      if (i == 0 && !is_first) enter(lane_group.chain.front(), route_.legs.back());
      from = to;
    }
    route_.lane_changes += static_cast<int>(lane_group.chain.size()) - 1;
  }

  Route take() && {
    route_.legs.back().exit = LegExit::goal;
    for (const RouteLeg& leg : route_.legs) {
      route_.cost_s += leg.cost_s;
      route_.cost_m += leg.cost_m;
      route_.length_m += leg.length_m;
      route_.legs_of_unknown_speed += leg.limit_known ? 0 : 1;
    }
    return std::move(route_);
  }

 private:
  RouteLeg leg(const LaneGroup& lane_group, std::size_t i, FractionRange part) const {
    const std::uint32_t lane = lane_group.chain[i], last = lane_group.chain.back();
    const double lane_m = network_.lanes[lane].length_m, last_m = network_.lanes[last].length_m;
    RouteLeg leg{.lane = network_.on_map(lane),
                 .reversed = network_.is_reversed(lane),
                 .from_s_m = network_.mirrored_m(lane, part.from * lane_m),
                 .to_s_m = network_.mirrored_m(lane, part.to * lane_m),
                 .exit = LegExit::successor,
                 .turn = network_.lanes[lane].turn,
                 .change_window = {},
                 .length_m = (part.to - part.from) * last_m,
                 .cost_s = time_.travel_cost(last, part.from * last_m, part.to * last_m),
                 .cost_m = distance_.travel_cost(last, part.from * last_m, part.to * last_m),
                 .limit_known = limit_known_[lane]};
    if (i + 1 < lane_group.chain.size()) {
      const FractionRange& window = lane_group.changes.ranges[i];
      leg.change_window = {network_.mirrored_m(lane, window.from * lane_m),
                           network_.mirrored_m(lane, window.to * lane_m)};
      leg.exit = network_.lanes[lane].left == lane_group.chain[i + 1] ? LegExit::change_left
                                                                      : LegExit::change_right;
      leg.cost_s += time_.change_cost(1, lane_group.changes.room_m);
      leg.cost_m += distance_.change_cost(1, lane_group.changes.room_m);
    }
    return leg;
  }

  void enter(std::uint32_t lane, RouteLeg& leg) const {
    leg.cost_s += time_.turn_cost(lane);
    leg.cost_m += distance_.turn_cost(lane);
  }

  const RouteNetwork& network_;
  const RoutingCostModel &time_, &distance_;
  const std::vector<bool>& limit_known_;
  Route route_;
};

// Goes on with a route that starts where this one ends, on the same lane.
void append(Route& route, const Route& next) {
  RouteLeg& last = route.legs.back();
  const RouteLeg& first = next.legs.front();
  route.stops.push_back({route.legs.size() - 1, last.to_s_m});
  last.to_s_m = first.to_s_m;
  last.exit = first.exit;
  last.change_window = first.change_window;
  last.length_m += first.length_m;
  last.cost_s += first.cost_s;
  last.cost_m += first.cost_m;
  route.legs.insert(route.legs.end(), next.legs.begin() + 1, next.legs.end());
  route.cost_s += next.cost_s;
  route.cost_m += next.cost_m;
  route.length_m += next.length_m;
  route.lane_changes += next.lane_changes;
  route.legs_of_unknown_speed += next.legs_of_unknown_speed - (first.limit_known ? 0 : 1);
}

/// The cheapest ways over the first places to the last of them, driven through in one direction.
struct Partial {
  RoutePlace at;
  std::vector<Way> ways;
  std::uint64_t cost = 0;
};

std::optional<Partial> cheapest(RouteSolver& solver, const std::vector<Partial>& partials,
                                const RoutePlace& to) {
  std::optional<Partial> best;
  for (const Partial& before : partials) {
    auto way = solver.solve(before.at, to);
    if (!way || (best && before.cost + way->cost >= best->cost)) continue;
    best = Partial{to, before.ways, before.cost + way->cost};
    best->ways.push_back(std::move(*way));
  }
  return best;
}

// A place that is passed, as it may be driven through: the way goes on as it came.
std::vector<RoutePlace> as_driven(const RouteNetwork& network, const RoutePlace& place) {
  std::vector<RoutePlace> driven;
  for (const RoutePlace& one : each_lane_of(place)) {
    const bool is_one_way = network.lanes[one.lane.index].contraflow_twin == kNoLane;
    if (is_one_way || one.sense != Sense::either) {
      driven.push_back(one);
    } else {
      for (const Sense sense : {Sense::along, Sense::against}) driven.emplace_back(one, sense);
    }
  }
  return driven;
}

std::string place_name(std::size_t index, std::size_t count) {
  if (index == 0) return "start";
  return index + 1 == count ? "goal" : fmt::format("via point {}", index);
}

}  // namespace

/// The same rules by both measures, whichever of them is the cost.
struct Router::Measures {
  RouteOptions by_time, by_distance;
  RoutingCostModel time, distance;
  std::vector<bool> limit_known;  ///< of each lane of the network

  Measures(const RouteNetwork& network, const RouteOptions& options)
      : by_time(with(options, RouteCost::time)),
        by_distance(with(options, RouteCost::distance)),
        time(network, by_time),
        distance(network, by_distance) {
    for (std::uint32_t lane = 0; lane < network.lanes.size(); ++lane) {
      limit_known.push_back(knows_limit(network, lane));
    }
  }

  static RouteOptions with(RouteOptions options, RouteCost cost) {
    options.cost = cost;
    return options;
  }
};

Router::Router(const map::RoadMap& road_map, RouteOptions options)
    : road_map_(&road_map), options_(std::move(options)) {
  for (const map::LaneId lane : options_.avoid) {
    if (lane.index >= road_map.lanes().size()) {
      throw std::invalid_argument("Router: a closed lane is not in the map");
    }
  }
  for (const BlockedStretch& stretch : options_.blocked) check(road_map, stretch);
  solver_ = std::make_unique<RouteSolver>(
      std::make_shared<const RouteNetwork>(route_network_of(road_map)), options_);
  measures_ = std::make_unique<const Measures>(solver_->network(), options_);
}

Router::~Router() = default;

void Router::prepare() { solver_->prepare(); }

Router::Router(Router&&) noexcept = default;
Router& Router::operator=(Router&&) noexcept = default;

bool Router::is_fit(const RoutePlace& place) const {
  return std::ranges::any_of(each_lane_of(place), [this](const RoutePlace& one) {
    return solver_->model().may_enter(one.lane.index);
  });
}

std::string Router::unfit(const RoutePlace& place, const std::string& what) const {
  if (is_fit(place)) return "";
  const map::Lane& lane = road_map_->lane(place.lane);
  const RoutingCostModel& model = solver_->model();
  if (!model.may_be_used(place.lane.index)) {
    return fmt::format("the {} is on lane {}, where a {} may not drive: its type is {}", what,
                       lane.name, to_string(options_.participant), map::to_string(lane.type));
  }
  if (model.is_closed(place.lane.index)) {
    return fmt::format("the {} is on lane {}, which is closed", what, lane.name);
  }
  return "";
}

Route Router::route_along(const Way& way) const {
  Assembly assembly(measures_->time, measures_->distance, measures_->limit_known,
                    way.lane_groups.size());
  for (std::size_t i = 0; i < way.lane_groups.size(); ++i) assembly.add(way.lane_groups[i], i == 0);
  return std::move(assembly).take();
}

RouteAnswer Router::find(const RoutePlace& from, const RoutePlace& to) {
  const RoutePlace places[] = {from, to};
  return find(places);
}

RouteAnswer Router::find(std::span<const RoutePlace> places) {
  if (places.size() < 2) throw std::invalid_argument("Router: a route needs two places");
  for (std::size_t i = 0; i < places.size(); ++i) {
    check(*road_map_, places[i]);
    if (is_fit(places[i])) continue;
    std::string fault = unfit(places[i], place_name(i, places.size()));
    return {{}, std::move(fault), {}, i == 0 ? 0 : i - 1};
  }
  std::vector<Partial> partials(1, {places.front(), {}, 0});
  for (std::size_t i = 0; i + 1 < places.size(); ++i) {
    std::vector<Partial> longer;
    const bool is_last = i + 2 == places.size();
    for (const RoutePlace& to :
         is_last ? std::vector{places[i + 1]} : as_driven(solver_->network(), places[i + 1])) {
      if (auto best = cheapest(*solver_, partials, to)) longer.push_back(std::move(*best));
    }
    if (longer.empty()) return refusal(places, partials.front().at, i);
    partials = std::move(longer);
  }
  return {lay_out(partials.front().ways), {}, {}, 0};
}

RouteAnswer Router::refusal(std::span<const RoutePlace> places, const RoutePlace& from,
                            std::size_t part) {
  if (!explainer_) explainer_ = std::make_unique<NoRouteExplainer>(*road_map_, *solver_);
  const RoutePlace& to = places[part + 1];
  const NoRouteExplanation explanation = explainer_->find(from, to);
  return {{}, describe(*road_map_, from, to, explanation), explanation, part};
}

Route Router::lay_out(const std::vector<Way>& ways) const {
  Route route = route_along(ways.front());
  for (std::size_t i = 1; i < ways.size(); ++i) append(route, route_along(ways[i]));
  return route;
}

RouteAnswer find_route(const map::RoadMap& road_map, const RoutePlace& from, const RoutePlace& to,
                       const RouteOptions& options) {
  return Router(road_map, options).find(from, to);
}

}  // namespace roadbed::planning::route
