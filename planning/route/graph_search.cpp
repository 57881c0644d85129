#include "roadbed/planning/route/graph_search.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>

namespace roadbed::planning::inline route {
namespace {

constexpr std::uint32_t kNoGoal = 0xffffffffU;

std::uint64_t entry(Ticks estimate, std::uint32_t node) {
  return static_cast<std::uint64_t>(estimate) << 32 | node;
}

}  // namespace

// No arc costs less per metre between its ends than the cheapest of all, so distance times that
// never overestimates, and falls along an arc by at most what the arc costs: A* settles each node
// once.
Guide make_guide(const RouteGraph& graph, const RouteNetwork& network,
                 std::span<const Ticks> weights) {
  Guide guide;
  for (const std::uint32_t lane : graph.lane_of_node) {
    guide.place_in_map.push_back(network.lanes[lane].start_in_map);
  }
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t arc = 0; arc < graph.arcs(); ++arc) {
    if (weights[arc] == kNever) continue;
    const double distance_m =
        (guide.place_in_map[graph.head[arc]] - guide.place_in_map[graph.tail[arc]]).norm();
    if (distance_m > 0.0) least = std::min(least, static_cast<double>(weights[arc]) / distance_m);
  }
  // A little less, so that rounding never lets the bound fall by more than an arc costs.
  guide.ticks_per_m = std::isfinite(least) ? least * (1.0 - 1e-9) : 0.0;
  return guide;
}

GraphSearch::GraphSearch(const RouteGraph& graph)
    : graph_(graph), states_(graph.nodes()), goal_of_(graph.nodes(), kNoGoal) {}

GraphSearch::State& GraphSearch::state(std::uint32_t node) {
  State& state = states_[node];
  if (state.round == round_) return state;
  state = {kNever, 0, round_, 0};
  if (guide_ != nullptr) {
    const double distance_m = (guide_->place_in_map[node] - goal_in_map_).norm() - goal_radius_m_;
    const double ahead = std::max(0.0, distance_m * guide_->ticks_per_m);
    state.ahead = static_cast<Ticks>(std::min(ahead, static_cast<double>(kNever)));
  }
  return state;
}

void GraphSearch::begin() {
  ++round_;
  heap_.clear();
}

// A node that gets cheaper leaves its former entry in the heap; entries whose estimate is no longer
// the node's are passed over when they come up. Equal estimates come up by node, in any run.
void GraphSearch::improve(std::uint32_t node, Ticks cost, std::uint32_t parent) {
  State& at = state(node);
  if (cost >= at.cost) return;
  at.cost = cost;
  at.parent = parent;
  heap_.push_back(entry(cost + at.ahead, node));
  std::push_heap(heap_.begin(), heap_.end(), std::greater<>());
}

GraphPath GraphSearch::find(std::span<const Ticks> weights, const Guide& guide,
                            std::span<const Seed> from, std::span<const Seed> to) {
  begin();
  if (to.empty()) return {};
  guide_ = &guide;
  goal_in_map_ = guide.place_in_map[to.front().node];
  goal_radius_m_ = 0.0;
  for (std::uint32_t i = 0; i < to.size(); ++i) {
    const Eigen::Vector2d place = guide.place_in_map[to[i].node];
    goal_radius_m_ = std::max(goal_radius_m_, (place - goal_in_map_).norm());
    std::uint32_t& goal = goal_of_[to[i].node];
    if (goal == kNoGoal || to[i].cost < to[goal].cost) goal = i;
  }
  for (std::uint32_t i = 0; i < from.size(); ++i) {
    improve(from[i].node, from[i].cost, kSeedBit | i);
  }
  Ticks best = kNever;
  std::uint32_t best_node = 0;
  while (!heap_.empty()) {
    const auto estimate = static_cast<Ticks>(heap_.front() >> 32);
    const auto node = static_cast<std::uint32_t>(heap_.front());
    // Estimates never fall: whatever follows reaches no goal for less.
    if (estimate >= best) break;
    std::pop_heap(heap_.begin(), heap_.end(), std::greater<>());
    heap_.pop_back();
    const State at = states_[node];
    if (estimate != at.cost + at.ahead) continue;
    if (const std::uint32_t goal = goal_of_[node];
        goal != kNoGoal && at.cost + to[goal].cost < best) {
      best = at.cost + to[goal].cost;
      best_node = node;
    }
    for (std::uint32_t arc = graph_.first_out[node]; arc < graph_.first_out[node + 1]; ++arc) {
      if (weights[arc] != kNever) improve(graph_.head[arc], at.cost + weights[arc], arc);
    }
  }
  GraphPath path;
  if (best < kNever) {
    path = trace(best_node);
    path.cost = best;
    path.to_seed = goal_of_[best_node];
  }
  for (const Seed& seed : to) goal_of_[seed.node] = kNoGoal;
  return path;
}

GraphPath GraphSearch::trace(std::uint32_t node) const {
  GraphPath path;
  std::uint32_t parent = states_[node].parent;
  while ((parent & kSeedBit) == 0) {
    path.arcs.push_back(parent);
    parent = states_[graph_.tail[parent]].parent;
  }
  path.from_seed = parent & ~kSeedBit;
  std::reverse(path.arcs.begin(), path.arcs.end());
  return path;
}

std::vector<Settled> GraphSearch::reach(std::span<const Ticks> weights, std::span<const Seed> from,
                                        Ticks limit, bool backward) {
  begin();
  guide_ = nullptr;
  for (const Seed& seed : from) {
    if (seed.cost <= limit) improve(seed.node, seed.cost, 0);
  }
  std::vector<Settled> settled;
  while (!heap_.empty()) {
    const auto cost = static_cast<Ticks>(heap_.front() >> 32);
    const auto node = static_cast<std::uint32_t>(heap_.front());
    std::pop_heap(heap_.begin(), heap_.end(), std::greater<>());
    heap_.pop_back();
    if (cost != states_[node].cost) continue;
    settled.push_back({node, cost});
    const std::uint32_t first = backward ? graph_.first_in[node] : graph_.first_out[node];
    const std::uint32_t last = backward ? graph_.first_in[node + 1] : graph_.first_out[node + 1];
    for (std::uint32_t i = first; i < last; ++i) {
      const std::uint32_t arc = backward ? graph_.in_arc[i] : i;
      if (weights[arc] == kNever || cost + weights[arc] > limit) continue;
      improve(backward ? graph_.tail[arc] : graph_.head[arc], cost + weights[arc], 0);
    }
  }
  return settled;
}

}  // namespace roadbed::planning::route
