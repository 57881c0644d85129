#include "roadbed/planning/hierarchy_metric.h"

#include <algorithm>
#include <queue>

#include "roadbed/planning/hierarchy_kernel.h"

namespace roadbed::planning {
namespace {

constexpr auto kFar = static_cast<std::int32_t>(kNever);

// Visits the ranks that lead up to both, the last ones first: the arcs to the first and to the
// second. Stops at true. The shorter list is walked and looked up in the other one, if the arc to
// the rank whose list it is may be `of_use`.
template <typename OfUse, typename Visit>
void for_each_below(const Hierarchy& hierarchy, std::uint32_t one, std::uint32_t other,
                    const OfUse& of_use, const Visit& visit) {
  const bool one_is_shorter = hierarchy.below.of(one).size() <= hierarchy.below.of(other).size();
  const std::uint32_t walked = one_is_shorter ? one : other,
                      looked_up = one_is_shorter ? other : one;
  const auto ranks = hierarchy.below.of(walked);
  for (auto rank = ranks.rbegin(); rank != ranks.rend(); ++rank) {
    const std::uint32_t near = hierarchy.arc_between(*rank, walked);
    if (!of_use(near, one_is_shorter)) continue;
    const std::uint32_t far = hierarchy.arc_between(*rank, looked_up);
    if (far == kNoNode) continue;
    if (visit(*rank, one_is_shorter ? near : far, one_is_shorter ? far : near)) return;
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

// The least weights that an arc can have, knowing that they are not below `least`.
HierarchyMetric::Both HierarchyMetric::compute(std::uint32_t low, std::uint32_t high,
                                               const Both& least) const {
  Both both{own_weight(low, high), own_weight(high, low)};
  const auto may_help = [&](std::uint32_t arc, bool to_low) {
    return (to_low ? down_[arc] : up_[arc]) < both.up ||
           (to_low ? up_[arc] : down_[arc]) < both.down;
  };
  if (both == least) return both;
  for_each_below(hierarchy_, low, high, may_help,
                 [&](std::uint32_t, std::uint32_t to_low, std::uint32_t to_high) {
                   both.up = std::min(both.up, down_[to_low] + up_[to_high]);
                   both.down = std::min(both.down, down_[to_high] + up_[to_low]);
                   return both == least;
                 });
  return {std::min(both.up, kFar), std::min(both.down, kFar)};
}

template <typename Visit>
void HierarchyMetric::for_each_beside(const Touched& arc, const Both& old, const Both& now,
                                      const Visit& visit) const {
  const bool down_changed = old.down != now.down, up_changed = old.up != now.up;
  auto target = hierarchy_.above.of(arc.high).begin();
  for (const RankRun& run : hierarchy_.above.of(arc.low)) {
    for (std::uint32_t i = 0; i < run.count; ++i) {
      const std::uint32_t other = run.first + i, beside = run.first_arc + i;
      const bool out = down_changed && up_[beside] < kFar;
      const bool in = up_changed && down_[beside] < kFar;
      if (other == arc.high || (!out && !in)) continue;
      if (other < arc.high) {
        visit(Touched{other, arc.high, hierarchy_.arc_between(other, arc.high)}, beside, out, in);
        continue;
      }
      while (target->first + target->count <= other) ++target;
      visit(Touched{arc.high, other, target->first_arc + (other - target->first)}, beside, out, in);
    }
  }
}

std::size_t HierarchyMetric::change(std::span<const std::uint32_t> graph_arcs,
                                    std::span<const Ticks> weights) {
  ++version_;
  // What gets cheaper waits: `lower` has to see it fall.
  const auto set = [&](bool rising) {
    std::vector<std::uint32_t> changed;
    for (std::size_t i = 0; i < graph_arcs.size(); ++i) {
      const std::uint32_t arc = graph_arcs[i];
      if (rising ? weights[i] <= weights_[arc] : weights[i] >= weights_[arc]) continue;
      weights_[arc] = weights[i];
      if (hierarchy_.arc_of[arc] != kNoNode) changed.push_back(arc);
    }
    return changed;
  };
  const std::size_t raised = raise(set(true));
  return raised + lower(set(false));
}

HierarchyMetric::Touched HierarchyMetric::place_of(std::uint32_t graph_arc) const {
  const auto [low, high] = std::minmax(hierarchy_.rank_of_node[graph_.tail[graph_arc]],
                                       hierarchy_.rank_of_node[graph_.head[graph_arc]]);
  return {low, high, hierarchy_.arc_of[graph_arc]};
}

// Arcs above are affected where they rested on the old weight.
std::size_t HierarchyMetric::raise(std::span<const std::uint32_t> graph_arcs) {
  std::priority_queue<Touched, std::vector<Touched>, std::greater<>> touched;
  for (const std::uint32_t arc : graph_arcs) touched.push(place_of(arc));
  std::size_t computed = 0;
  std::uint32_t done = kNoNode;
  while (!touched.empty()) {
    const Touched next = touched.top();
    touched.pop();
    if (next.arc == done) continue;
    done = next.arc;
    ++computed;
    const Both old{up_[next.arc], down_[next.arc]};
    const Both now = compute(next.low, next.high, old);
    if (now == old) continue;
    for_each_beside(
        next, old, now, [&](const Touched& other, std::uint32_t beside, bool out, bool in) {
          const bool next_is_low = other.low == next.high;
          const std::int32_t from_next = next_is_low ? up_[other.arc] : down_[other.arc];
          const std::int32_t to_next = next_is_low ? down_[other.arc] : up_[other.arc];
          if ((out && old.down + up_[beside] <= from_next) ||
              (in && old.up + down_[beside] <= to_next)) {
            touched.push(other);
          }
        });
    up_[next.arc] = now.up;
    down_[next.arc] = now.down;
  }
  return computed;
}

// What has become cheaper is put into the arcs above where it is less.
std::size_t HierarchyMetric::lower(std::span<const std::uint32_t> graph_arcs) {
  std::priority_queue<Touched, std::vector<Touched>, std::greater<>> touched;
  const auto put = [&](const Touched& at, std::int32_t& weight, std::int32_t now) {
    if (now >= weight) return;
    weight = now;
    touched.push(at);
  };
  for (const std::uint32_t arc : graph_arcs) {
    const Touched at = place_of(arc);
    const bool upwards = hierarchy_.rank_of_node[graph_.tail[arc]] == at.low;
    put(at, upwards ? up_[at.arc] : down_[at.arc], static_cast<std::int32_t>(weights_[arc]));
  }
  std::size_t lowered = 0;
  std::uint32_t done = kNoNode;
  while (!touched.empty()) {
    const Touched next = touched.top();
    touched.pop();
    if (next.arc == done) continue;
    done = next.arc;
    ++lowered;
    const Both now{up_[next.arc], down_[next.arc]};
    for_each_beside(next, {kFar, kFar}, now,
                    [&](const Touched& other, std::uint32_t beside, bool out, bool in) {
                      const bool next_is_low = other.low == next.high;
                      std::int32_t& from_next = next_is_low ? up_[other.arc] : down_[other.arc];
                      std::int32_t& to_next = next_is_low ? down_[other.arc] : up_[other.arc];
                      if (out) put(other, from_next, now.down + up_[beside]);
                      if (in) put(other, to_next, now.up + down_[beside]);
                    });
  }
  return lowered;
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
  const auto may_be = [&](std::uint32_t over, bool to_low) {
    return (to_low == upwards ? down_[over] : up_[over]) <= weight;
  };
  for_each_below(hierarchy_, low, high, may_be,
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
