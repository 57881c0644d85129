#include "roadbed/planning/route/hierarchy_search.h"

#include <algorithm>

#include "roadbed/planning/route/hierarchy_kernel.h"

namespace roadbed::planning::inline route {
namespace {

std::uint32_t lowest(const std::vector<std::uint32_t>& open) {
  return open.empty() ? kNoNode : open.back();
}

}  // namespace

HierarchySearch::HierarchySearch(const HierarchyMetric& metric)
    : metric_(metric), known_(kKnown), known_version_(metric.version()) {
  const std::size_t nodes = metric.graph().nodes();
  for (Side* side : {&forward_, &backward_}) {
    side->cost.assign(nodes, kFar);
    side->parent.assign(nodes, 0);
  }
}

void HierarchySearch::start(Side& side, std::span<const Seed> seeds) const {
  side.open.clear();
  for (std::uint32_t i = 0; i < seeds.size(); ++i) {
    const std::uint32_t rank = metric_.hierarchy().rank_of_node[seeds[i].node];
    const auto cost = static_cast<std::int32_t>(std::min(seeds[i].cost, kNever));
    if (cost < side.cost[rank]) {
      side.cost[rank] = cost;
      side.parent[rank] = kSeedBit | i;
    }
    side.open.push_back(rank);
  }
  std::sort(side.open.begin(), side.open.end(), std::greater<>());
  side.open.erase(std::unique(side.open.begin(), side.open.end()), side.open.end());
}

// Goes on from a rank to its parent; ways that meet go on as one.
void HierarchySearch::step(Side& side, std::uint32_t rank) const {
  side.open.pop_back();
  const std::uint32_t parent = metric_.hierarchy().parent[rank];
  if (parent == rank) return;
  auto at = side.open.end();
  while (at != side.open.begin() && *(at - 1) < parent) --at;
  if (at != side.open.begin() && *(at - 1) == parent) return;
  side.open.insert(at, parent);
}

template <bool kTraced>
void HierarchySearch::relax(Side& side, const std::vector<std::int32_t>& weights,
                            std::uint32_t rank) const {
  const auto runs = metric_.hierarchy().above.of(rank);
  if constexpr (kTraced) {
    relax_row(runs, side.cost[rank], weights.data(), side.cost.data(), side.parent.data(), rank);
  } else {
    lower_row(runs, side.cost[rank], weights.data(), side.cost.data());
  }
}

template <bool kTraced>
HierarchySearch::Meeting HierarchySearch::meet(std::span<const Seed> from,
                                               std::span<const Seed> to) {
  start(forward_, from);
  start(backward_, to);
  Meeting best{kFar};
  while (!forward_.open.empty() || !backward_.open.empty()) {
    if (have_met()) return climb_together<kTraced>(best);
    const std::uint32_t rank = std::min(lowest(forward_.open), lowest(backward_.open));
    visited_.push_back(rank);
    const std::int32_t there = forward_.cost[rank], back = backward_.cost[rank];
    if (there + back < best.cost) best = {there + back, rank};
    if (lowest(forward_.open) == rank) {
      if (there < best.cost) relax<kTraced>(forward_, metric_.up(), rank);
      step(forward_, rank);
    }
    if (lowest(backward_.open) == rank) {
      if (back < best.cost) relax<kTraced>(backward_, metric_.down(), rank);
      step(backward_, rank);
    }
  }
  return best;
}

bool HierarchySearch::have_met() const {
  return forward_.open.size() == 1 && backward_.open.size() == 1 &&
         forward_.open.front() == backward_.open.front();
}

// Over the ranks that both sides still have before them.
template <bool kTraced>
HierarchySearch::Meeting HierarchySearch::climb_together(Meeting best) {
  const std::vector<std::uint32_t>& parent = metric_.hierarchy().parent;
  const std::size_t first = visited_.size();
  visited_.push_back(forward_.open.front());
  while (parent[visited_.back()] != visited_.back()) visited_.push_back(parent[visited_.back()]);
  const std::span<const std::uint32_t> ranks = std::span(visited_).subspan(first);
  BothWays ahead{0, 0};
  for (std::size_t i = 0; i < ranks.size(); ++i) {
    if (i % kStride == 0) ahead = least_ahead(ranks.subspan(i), best);
    const std::uint32_t rank = ranks[i];
    const std::int32_t there = forward_.cost[rank], back = backward_.cost[rank];
    if (there + back < best.cost) best = {there + back, rank};
    if (there + ahead.down < best.cost) relax<kTraced>(forward_, metric_.up(), rank);
    if (back + ahead.up < best.cost) relax<kTraced>(backward_, metric_.down(), rank);
  }
  return best;
}

// Least costs up to one of the ranks, and down from one, as known so far.
BothWays HierarchySearch::least_ahead(std::span<const std::uint32_t> ranks, Meeting& best) const {
  BothWays least{kFar, kFar};
  for (const std::uint32_t rank : ranks) {
    const std::int32_t there = forward_.cost[rank], back = backward_.cost[rank];
    least = {std::min(least.up, there), std::min(least.down, back)};
    if (there + back < best.cost) best = {there + back, rank};
  }
  return least;
}

void HierarchySearch::clear() {
  for (const std::uint32_t rank : visited_) {
    forward_.cost[rank] = backward_.cost[rank] = kFar;
  }
  visited_.clear();
}

Ticks HierarchySearch::cost(std::span<const Seed> from, std::span<const Seed> to) {
  const Meeting meeting = meet<false>(from, to);
  clear();
  return static_cast<Ticks>(meeting.cost);
}

// The ranks from a seed up to `rank`, in that order.
std::uint32_t HierarchySearch::seed_of(const Side& side, std::uint32_t rank,
                                       std::vector<std::uint32_t>& chain) const {
  chain.assign(1, rank);
  while ((side.parent[chain.back()] & kSeedBit) == 0) chain.push_back(side.parent[chain.back()]);
  std::reverse(chain.begin(), chain.end());
  return side.parent[chain.front()] & ~kSeedBit;
}

HierarchyMetric::Meaning HierarchySearch::meaning(std::uint32_t low, std::uint32_t high,
                                                  bool upwards) {
  const std::size_t place = (2654435761U * (2 * low + (upwards ? 1 : 0)) + high) % kKnown;
  Known& known = known_[place];
  if (known.low != low || known.high != high || known.upwards != upwards) {
    known = {low, high, upwards, metric_.meaning(low, high, upwards)};
  }
  return known.meaning;
}

// Arcs of the graph that an arc of the hierarchy stands for, appended in driving order.
void HierarchySearch::unpack(std::uint32_t low, std::uint32_t high, bool upwards,
                             std::vector<std::uint32_t>& arcs) {
  const auto [is_arc, arc_or_rank] = meaning(low, high, upwards);
  if (is_arc) {
    arcs.push_back(arc_or_rank);
    return;
  }
  unpack(arc_or_rank, upwards ? low : high, false, arcs);
  unpack(arc_or_rank, upwards ? high : low, true, arcs);
}

GraphPath HierarchySearch::find(std::span<const Seed> from, std::span<const Seed> to) {
  if (known_version_ != metric_.version()) {
    known_.assign(kKnown, {});
    known_version_ = metric_.version();
  }
  const Meeting meeting = meet<true>(from, to);
  GraphPath path;
  if (meeting.cost < kFar) {
    std::vector<std::uint32_t> chain;
    path.cost = static_cast<Ticks>(meeting.cost);
    path.from_seed = seed_of(forward_, meeting.rank, chain);
    for (std::size_t i = 0; i + 1 < chain.size(); ++i) {
      unpack(chain[i], chain[i + 1], true, path.arcs);
    }
    path.to_seed = seed_of(backward_, meeting.rank, chain);
    for (std::size_t i = chain.size() - 1; i > 0; --i) {
      unpack(chain[i - 1], chain[i], false, path.arcs);
    }
  }
  clear();
  return path;
}

ClimbedSpace HierarchySearch::climb(std::span<const Seed> seeds, bool backward) {
  ClimbedSpace space;
  Side& side = backward ? backward_ : forward_;
  start(side, seeds);
  while (!side.open.empty()) {
    const std::uint32_t rank = side.open.back();
    visited_.push_back(rank);
    if (side.cost[rank] < kFar) {
      space.ranks.push_back(rank);
      space.costs.push_back(side.cost[rank]);
      relax<false>(side, backward ? metric_.down() : metric_.up(), rank);
    }
    step(side, rank);
  }
  clear();
  return space;
}

Ticks cost_between(const ClimbedSpace& forward, const ClimbedSpace& backward) {
  std::int32_t best = kFar;
  std::size_t i = 0, j = 0;
  while (i < forward.ranks.size() && j < backward.ranks.size()) {
    if (forward.ranks[i] < backward.ranks[j]) {
      ++i;
    } else if (forward.ranks[i] > backward.ranks[j]) {
      ++j;
    } else {
      best = std::min(best, forward.costs[i++] + backward.costs[j++]);
    }
  }
  return static_cast<Ticks>(best);
}

}  // namespace roadbed::planning::route
