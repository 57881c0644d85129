#include "roadbed/planning/route/route_area.h"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>
#include <tuple>

#include "roadbed/planning/route/route_solver.h"

namespace roadbed::planning::inline route {
namespace {

ReachedLane reached_part(const RouteNetwork& network, std::uint32_t lane,
                         const map::StationRange& driven_m, double cost) {
  return {{network.on_map(lane), network.mirrored_m(lane, driven_m.from_s_m),
           network.mirrored_m(lane, driven_m.to_s_m)},
          network.is_reversed(lane),
          cost};
}

// From the place along its own lane group.
void add_own_passage(const RouteSolver& solver, const NetworkPlace& from, double limit,
                     std::vector<ReachedLane>& reached) {
  const RoutingCostModel& model = solver.model();
  const RouteNetwork& network = solver.network();
  if (!model.may_enter(from.lane)) return;
  const double fraction = from.s_m / std::max(1e-9, network.lanes[from.lane].length_m);
  for (const auto& chain : chains_from(network, from.lane)) {
    const auto plan = model.plan_changes(chain, {std::clamp(fraction, 0.0, 1.0), 1.0});
    if (!plan) continue;
    const double cost = model.change_cost(chain.size() - 1, plan->room_m);
    if (cost > limit) continue;
    const double from_m = std::clamp(fraction, 0.0, 1.0) * network.lanes[chain.back()].length_m;
    const double to_m = model.station_within(chain.back(), from_m, limit - cost);
    reached.push_back(reached_part(network, chain.back(), {from_m, to_m}, cost));
  }
}

}  // namespace

std::vector<ReachedLane> isochrone(Router& router, const RoutePlace& from, double limit) {
  RouteSolver& solver = router.solver();
  const RouteCost measure = router.options().cost;
  if (!(limit > 0.0) || to_ticks(limit, measure) == kNever) {
    throw std::invalid_argument(fmt::format("reach: a limit of {} is none", limit));
  }
  if (from.lane.index >= router.road_map().lanes().size()) {
    throw std::invalid_argument("reach: the place names no lane of the map");
  }
  std::vector<ReachedLane> reached;
  for (const NetworkPlace& way : ways_through(solver.network(), from)) {
    add_own_passage(solver, way, limit, reached);
  }
  for (const auto& [node, ticks] : solver.nodes_within(from, to_ticks(limit, measure))) {
    const std::uint32_t lane = solver.graph().lane_of_node[node];
    if (solver.graph().exit_of_lane[lane] != node) continue;
    const double cost = static_cast<double>(ticks) / ticks_per_unit(measure);
    const double to_m = solver.model().station_within(lane, 0.0, limit - cost);
    reached.push_back(reached_part(solver.network(), lane, {0.0, to_m}, cost));
  }
  std::sort(reached.begin(), reached.end(), [](const ReachedLane& a, const ReachedLane& b) {
    return std::tie(a.part.lane, a.cost) < std::tie(b.part.lane, b.cost);
  });
  return reached;
}

}  // namespace roadbed::planning::route
