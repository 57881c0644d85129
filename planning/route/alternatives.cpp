#include "roadbed/planning/route/alternatives.h"

#include <algorithm>
#include <cmath>

#include "roadbed/planning/route/route_solver.h"

namespace roadbed::planning::inline route {
namespace {

constexpr double kPenalty = 1.4;
constexpr int kSearches = 20;

void make_dearer(const RouteSolver& solver, const Route& route, std::vector<Ticks>& weights) {
  const RouteGraph& graph = solver.graph();
  for (const RouteLeg& leg : route.legs) {
    const std::uint32_t node = graph.exit_of_lane[solver.network().lane_of(leg.lane, leg.reversed)];
    for (std::uint32_t arc = graph.first_out[node]; arc < graph.first_out[node + 1]; ++arc) {
      if (weights[arc] == kNever) continue;
      const double dearer = kPenalty * static_cast<double>(weights[arc]);
      weights[arc] = static_cast<Ticks>(std::min(dearer, static_cast<double>(kNever - 1)));
    }
  }
}

double cost_of(const Route& route, RouteCost measure) {
  return measure == RouteCost::time ? route.cost_s : route.cost_m;
}

}  // namespace

double shared_length_ratio(const Route& route, const Route& other) {
  double shared_m = 0.0;
  for (const RouteLeg& leg : route.legs) {
    const double leg_m = std::abs(leg.to_s_m - leg.from_s_m);
    double common_m = 0.0;
    for (const RouteLeg& beside : other.legs) {
      if (beside.lane != leg.lane || beside.reversed != leg.reversed) continue;
      const auto [leg_from, leg_to] = std::minmax(leg.from_s_m, leg.to_s_m);
      const auto [beside_from, beside_to] = std::minmax(beside.from_s_m, beside.to_s_m);
      common_m += std::max(0.0, std::min(leg_to, beside_to) - std::max(leg_from, beside_from));
    }
    if (leg_m > 0.0) shared_m += leg.length_m * std::min(1.0, common_m / leg_m);
  }
  return route.length_m > 0.0 ? shared_m / route.length_m : 1.0;
}

std::vector<Alternative> find_alternatives(Router& router, const RoutePlace& from,
                                           const RoutePlace& to,
                                           const AlternativeOptions& options) {
  RouteSolver& solver = router.solver();
  std::vector<Alternative> found;
  std::vector<Ticks> weights = solver.weights();
  const RouteCost measure = router.options().cost;
  for (int i = 0; i < kSearches && std::ssize(found) < options.count; ++i) {
    const auto way = solver.solve_with(weights, from, to);
    if (!way) break;
    Alternative next{router.route_along(*way), 0.0};
    make_dearer(solver, next.route, weights);
    for (const Alternative& before : found) {
      next.shared = std::max(next.shared, shared_length_ratio(next.route, before.route));
    }
    const bool fits =
        found.empty() ||
        (next.shared <= options.most_shared &&
         cost_of(next.route, measure) <= options.most_cost * cost_of(found.front().route, measure));
    if (fits) found.push_back(std::move(next));
  }
  return found;
}

}  // namespace roadbed::planning::route
