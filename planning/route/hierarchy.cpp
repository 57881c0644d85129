#include "roadbed/planning/route/hierarchy.h"

#include <algorithm>

namespace roadbed::planning::inline route {
namespace {

using Rank = std::uint32_t;

// The ranks above of each rank, as runs: what it is linked to and what its children lead to.
class Elimination {
 public:
  Elimination(const RouteGraph& graph, Hierarchy& hierarchy)
      : graph_(graph),
        hierarchy_(hierarchy),
        first_child_(graph.nodes(), kNoNode),
        next_child_(graph.nodes(), kNoNode) {}

  void run() {
    hierarchy_.parent.resize(graph_.nodes());
    for (Rank rank = 0; rank < graph_.nodes(); ++rank) {
      gather(rank);
      store(rank);
    }
  }

 private:
  void take(Rank rank, Rank other) {
    if (other > rank) row_.push_back(other);
  }

  void gather(Rank rank) {
    row_.clear();
    const std::uint32_t node = hierarchy_.node_of_rank[rank];
    for (std::uint32_t i = graph_.first_out[node]; i < graph_.first_out[node + 1]; ++i) {
      take(rank, hierarchy_.rank_of_node[graph_.head[i]]);
    }
    for (std::uint32_t i = graph_.first_in[node]; i < graph_.first_in[node + 1]; ++i) {
      take(rank, hierarchy_.rank_of_node[graph_.tail[graph_.in_arc[i]]]);
    }
    std::sort(row_.begin(), row_.end());
    row_.erase(std::unique(row_.begin(), row_.end()), row_.end());
    for (Rank child = first_child_[rank]; child != kNoNode; child = next_child_[child]) {
      merge_runs(rank, child);
    }
  }

  // Both are sorted; the child's first one is the rank itself.
  void merge_runs(Rank rank, Rank child) {
    other_.clear();
    for (const RankRun& run : hierarchy_.above.of(child)) {
      for (Rank i = 0; i < run.count; ++i) {
        if (run.first + i > rank) other_.push_back(run.first + i);
      }
    }
    merged_.clear();
    std::set_union(row_.begin(), row_.end(), other_.begin(), other_.end(),
                   std::back_inserter(merged_));
    row_.swap(merged_);
  }

  void store(Rank rank) {
    auto& runs = hierarchy_.above.items;
    const std::size_t first = runs.size();
    for (const Rank other : row_) {
      if (runs.size() > first && runs.back().first + runs.back().count == other) {
        ++runs.back().count;
      } else {
        runs.push_back({other, 1, hierarchy_.arcs});
      }
      ++hierarchy_.arcs;
    }
    hierarchy_.above.end_list();
    hierarchy_.parent[rank] = row_.empty() ? rank : row_.front();
    if (row_.empty()) return;
    next_child_[rank] = first_child_[row_.front()];
    first_child_[row_.front()] = rank;
  }

  const RouteGraph& graph_;
  Hierarchy& hierarchy_;
  std::vector<Rank> first_child_, next_child_, row_, other_, merged_;
};

// Visits each arc by its ranks, in the order of its lower one.
template <typename Visit>
void for_each_arc_up(const Hierarchy& hierarchy, const Visit& visit) {
  for (Rank low = 0; low < hierarchy.parent.size(); ++low) {
    for (const RankRun& run : hierarchy.above.of(low)) {
      for (Rank high = run.first; high < run.end(); ++high) visit(low, high);
    }
  }
}

// Counted first, then filled: both passes see the ranks below in ascending order.
CsrLists<RankRun> runs_below(const Hierarchy& hierarchy) {
  const std::size_t ranks = hierarchy.parent.size();
  CsrLists<RankRun> below;
  below.first.assign(ranks + 1, 0);
  std::vector<Rank> arcs(ranks, 0), last(ranks, kNoNode - 1);
  for_each_arc_up(hierarchy, [&](Rank low, Rank high) {
    if (last[high] + 1 != low) ++below.first[high + 1];
    last[high] = low;
    ++arcs[high];
  });
  for (std::size_t i = 0; i < ranks; ++i) below.first[i + 1] += below.first[i];
  below.items.resize(below.first.back());
  std::vector<Rank> next(below.first.begin(), below.first.end() - 1), first_arc(ranks, 0);
  for (std::size_t i = 0; i + 1 < ranks; ++i) first_arc[i + 1] = first_arc[i] + arcs[i];
  for_each_arc_up(hierarchy, [&](Rank low, Rank high) {
    const bool goes_on = next[high] > below.first[high] && below.items[next[high] - 1].end() == low;
    if (!goes_on) below.items[next[high]++] = {low, 0, first_arc[high]};
    ++below.items[next[high] - 1].count;
    ++first_arc[high];
  });
  return below;
}

// The place of the arc to a rank that a list of runs may hold.
std::uint32_t place_in(std::span<const RankRun> runs, Rank sought) {
  const auto after =
      std::upper_bound(runs.begin(), runs.end(), sought,
                       [](Rank rank, const RankRun& run) { return rank < run.first; });
  if (after == runs.begin()) return kNoNode;
  const RankRun& run = *(after - 1);
  return sought < run.end() ? run.first_arc + (sought - run.first) : kNoNode;
}

}  // namespace

std::uint32_t Hierarchy::arc_between(std::uint32_t low, std::uint32_t high) const {
  return place_in(above.of(low), high);
}

std::uint32_t Hierarchy::place_below(std::uint32_t low, std::uint32_t high) const {
  return place_in(below.of(high), low);
}

Hierarchy make_hierarchy(const RouteGraph& graph, const std::vector<std::uint32_t>& order) {
  Hierarchy made;
  made.node_of_rank = order;
  made.rank_of_node.resize(graph.nodes());
  for (Rank rank = 0; rank < order.size(); ++rank) made.rank_of_node[order[rank]] = rank;
  Elimination(graph, made).run();
  made.above.items.shrink_to_fit();
  made.below = runs_below(made);
  made.arc_of.assign(graph.arcs(), kNoNode);
  for (std::uint32_t arc = 0; arc < graph.arcs(); ++arc) {
    const auto [low, high] =
        std::minmax(made.rank_of_node[graph.tail[arc]], made.rank_of_node[graph.head[arc]]);
    if (low != high) made.arc_of[arc] = made.arc_between(low, high);
  }
  return made;
}

}  // namespace roadbed::planning::route
