#pragma once

#include <memory>
#include <span>
#include <vector>

#include "roadbed/planning/route/graph_search.h"

namespace roadbed::tests {

/// Boost.Graph's Dijkstra and A* on the same graph and weights: an oracle, and something to be
/// compared with. Boost's compressed rows, stopped at the goal, no memory kept between questions
/// but what the algorithms are given.
class BoostRoutes {
 public:
  BoostRoutes(const planning::RouteGraph& graph, std::vector<planning::Ticks> weights);
  ~BoostRoutes();

  void set_weight(std::uint32_t arc, planning::Ticks weight);

  /// Costs from one node to all; kNever where no way leads.
  const std::vector<planning::Ticks>& costs_from(std::uint32_t node);

  planning::Ticks dijkstra(std::uint32_t from, std::uint32_t to);
  planning::Ticks a_star(std::uint32_t from, std::uint32_t to, const planning::Guide& guide);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace roadbed::tests
