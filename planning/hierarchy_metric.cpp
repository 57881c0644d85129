#include "roadbed/planning/hierarchy_metric.h"

#include <algorithm>
#include <queue>
#include <tuple>

#include "roadbed/planning/hierarchy_kernel.h"

namespace roadbed::planning {
namespace {

constexpr auto kFar = static_cast<std::int32_t>(kNever);

// Visits the ranks that lead up to both: the arcs to the first and to the second. Stops at true.
// The shorter list is walked and looked up in the other one.
template <typename Visit>
void for_each_below(const Hierarchy& hierarchy, std::uint32_t one, std::uint32_t other,
                    const Visit& visit) {
  const bool one_is_shorter = hierarchy.below.of(one).size() <= hierarchy.below.of(other).size();
  const std::uint32_t walked = one_is_shorter ? one : other,
                      looked_up = one_is_shorter ? other : one;
  for (const std::uint32_t rank : hierarchy.below.of(walked)) {
    const std::uint32_t far = hierarchy.arc_between(rank, looked_up);
    if (far == kNoNode) continue;
    const std::uint32_t near = hierarchy.arc_between(rank, walked);
    if (visit(rank, one_is_shorter ? near : far, one_is_shorter ? far : near)) return;
  }
}

// Visits the arcs of the graph between two nodes. Stops at true.
template <typename Visit>
void for_each_arc(const RouteGraph& graph, std::uint32_t from, std::uint32_t to,
                  const Visit& visit) {
  for (std::uint32_t arc = graph.first_out[from]; arc < graph.first_out[from + 1]; ++arc) {
    if (graph.head[arc] == to && visit(arc)) return;
  }
}

// An arc of the hierarchy that has to be computed again; lower ones first.
struct Touched {
  std::uint32_t low, high, arc;
  bool operator>(const Touched& other) const {
    return std::tie(low, high) > std::tie(other.low, other.high);
  }
};

}  // namespace

HierarchyMetric::HierarchyMetric(const RouteGraph& graph, const Hierarchy& hierarchy,
                                 std::span<const Ticks> weights)
    : graph_(graph),
      hierarchy_(hierarchy),
      weights_(weights.begin(), weights.end()),
      up_(hierarchy.arcs, kFar),
      down_(hierarchy.arcs, kFar) {
  for (std::uint32_t arc = 0; arc < graph.arcs(); ++arc) {
    const std::uint32_t at = hierarchy.arc_of[arc];
    if (at == kNoNode) continue;
    const bool upwards =
        hierarchy.rank_of_node[graph.tail[arc]] < hierarchy.rank_of_node[graph.head[arc]];
    std::int32_t& weight = upwards ? up_[at] : down_[at];
    weight = std::min(weight, static_cast<std::int32_t>(weights_[arc]));
  }
  for (std::uint32_t rank = 0; rank < graph.nodes(); ++rank) customise(rank);
}

// The ranks above a rank are joined to each other over it.
void HierarchyMetric::customise(std::uint32_t rank) {
  const auto runs = hierarchy_.above.of(rank);
  for (std::size_t r = 0; r < runs.size(); ++r) {
    for (std::uint32_t i = 0; i < runs[r].count; ++i) {
      const std::uint32_t low = runs[r].first + i, over = runs[r].first_arc + i;
      const std::int32_t down = down_[over], up = up_[over];
      if (down == kFar && up == kFar) continue;
      auto target = hierarchy_.above.of(low).begin();
      for (std::size_t q = r; q < runs.size(); ++q) {
        const std::uint32_t skip = q == r ? i + 1 : 0, count = runs[q].count - skip;
        if (count == 0) continue;
        const std::uint32_t first = runs[q].first + skip, from = runs[q].first_arc + skip;
        while (target->first + target->count <= first) ++target;
        const std::uint32_t to = target->first_arc + (first - target->first);
        if (down != kFar) lower_run(count, down, &up_[from], &up_[to]);
        if (up != kFar) lower_run(count, up, &down_[from], &down_[to]);
      }
    }
  }
}

std::int32_t HierarchyMetric::own_weight(std::uint32_t from, std::uint32_t to) const {
  std::int32_t least = kFar;
  for_each_arc(graph_, hierarchy_.node_of_rank[from], hierarchy_.node_of_rank[to],
               [&](std::uint32_t arc) {
                 least = std::min(least, static_cast<std::int32_t>(weights_[arc]));
                 return false;
               });
  return least;
}

HierarchyMetric::Both HierarchyMetric::compute(std::uint32_t low, std::uint32_t high) const {
  Both both{own_weight(low, high), own_weight(high, low)};
  for_each_below(hierarchy_, low, high,
                 [&](std::uint32_t, std::uint32_t to_low, std::uint32_t to_high) {
                   both.up = std::min(both.up, down_[to_low] + up_[to_high]);
                   both.down = std::min(both.down, down_[to_high] + up_[to_low]);
                   return false;
                 });
  return {std::min(both.up, kFar), std::min(both.down, kFar)};
}

std::size_t HierarchyMetric::change(std::span<const std::uint32_t> graph_arcs,
                                    std::span<const Ticks> weights) {
  ++version_;
  std::priority_queue<Touched, std::vector<Touched>, std::greater<>> touched;
  for (std::size_t i = 0; i < graph_arcs.size(); ++i) {
    const std::uint32_t arc = graph_arcs[i], at = hierarchy_.arc_of[arc];
    if (weights_[arc] == weights[i]) continue;
    weights_[arc] = weights[i];
    if (at == kNoNode) continue;
    const auto [low, high] = std::minmax(hierarchy_.rank_of_node[graph_.tail[arc]],
                                         hierarchy_.rank_of_node[graph_.head[arc]]);
    touched.push({low, high, at});
  }
  std::size_t computed = 0;
  std::uint32_t done = kNoNode;
  while (!touched.empty()) {
    const Touched next = touched.top();
    touched.pop();
    if (next.arc == done) continue;
    done = next.arc;
    ++computed;
    const Both old{up_[next.arc], down_[next.arc]};
    const Both now = compute(next.low, next.high);
    if (now == old) continue;
    // Arcs above are affected where they rested on the old weight, or the new one is less.
    const bool down_changed = old.down != now.down, up_changed = old.up != now.up;
    for (const RankRun& run : hierarchy_.above.of(next.low)) {
      for (std::uint32_t i = 0; i < run.count; ++i) {
        const std::uint32_t other = run.first + i, beside = run.first_arc + i;
        const bool out = down_changed && up_[beside] < kFar;
        const bool in = up_changed && down_[beside] < kFar;
        if (other == next.high || (!out && !in)) continue;
        const std::uint32_t low = std::min(other, next.high), high = std::max(other, next.high);
        const std::uint32_t arc = hierarchy_.arc_between(low, high);
        // next → other and other → next, over their common low rank.
        const bool next_is_low = next.high < other;
        const std::int32_t from_next = next_is_low ? up_[arc] : down_[arc];
        const std::int32_t to_next = next_is_low ? down_[arc] : up_[arc];
        const bool touches_out =
            out && (old.down + up_[beside] <= from_next || now.down + up_[beside] < from_next);
        const bool touches_in =
            in && (old.up + down_[beside] <= to_next || now.up + down_[beside] < to_next);
        if (touches_out || touches_in) touched.push({low, high, arc});
      }
    }
    up_[next.arc] = now.up;
    down_[next.arc] = now.down;
  }
  return computed;
}

HierarchyMetric::Meaning HierarchyMetric::meaning(std::uint32_t low, std::uint32_t high,
                                                  bool upwards) const {
  const std::uint32_t arc = hierarchy_.arc_between(low, high);
  const std::int32_t weight = upwards ? up_[arc] : down_[arc];
  Meaning found;
  for_each_arc(graph_, hierarchy_.node_of_rank[upwards ? low : high],
               hierarchy_.node_of_rank[upwards ? high : low], [&](std::uint32_t of_graph) {
                 if (static_cast<std::int32_t>(weights_[of_graph]) != weight) return false;
                 found = {true, of_graph};
                 return true;
               });
  if (found.is_arc) return found;
  for_each_below(hierarchy_, low, high,
                 [&](std::uint32_t rank, std::uint32_t to_low, std::uint32_t to_high) {
                   const std::int32_t way =
                       upwards ? down_[to_low] + up_[to_high] : down_[to_high] + up_[to_low];
                   if (way != weight) return false;
                   found.arc_or_rank = rank;
                   return true;
                 });
  return found;
}

}  // namespace roadbed::planning
