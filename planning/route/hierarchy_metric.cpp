#include "roadbed/planning/route/hierarchy_metric.h"

#include <algorithm>
#include <queue>

#include "roadbed/planning/route/hierarchy_kernel.h"

namespace roadbed::planning::inline route {
namespace {

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
  turn();
}

// Ranks come in ascending order, as those below a rank do.
void HierarchyMetric::turn() {
  up_below_.resize(up_.size());
  down_below_.resize(down_.size());
  std::vector<std::uint32_t> next;
  for (std::uint32_t rank = 0; rank < graph_.nodes(); ++rank) {
    const auto below = hierarchy_.below.of(rank);
    next.push_back(below.empty() ? 0 : below.front().first_arc);
    for (const RankRun& run : hierarchy_.above.of(rank)) {
      found_.resize(std::max<std::size_t>(found_.size(), run.count));
    }
  }
  for (std::uint32_t rank = 0; rank < graph_.nodes(); ++rank) {
    for (const RankRun& run : hierarchy_.above.of(rank)) {
      for (std::uint32_t i = 0; i < run.count; ++i) {
        const std::uint32_t place = next[run.first + i]++;
        up_below_[place] = up_[run.first_arc + i];
        down_below_[place] = down_[run.first_arc + i];
      }
    }
  }
}

void HierarchyMetric::set(const Touched& arc, BothWays weights) {
  const std::uint32_t place = hierarchy_.place_below(arc.low, arc.high);
  up_[arc.arc] = up_below_[place] = weights.up;
  down_[arc.arc] = down_below_[place] = weights.down;
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
BothWays HierarchyMetric::compute(std::uint32_t low, std::uint32_t high,
                                  const BothWays& least) const {
  BothWays both{own_weight(low, high), own_weight(high, low)};
  if (both == least) return both;
  for_each_shared(
      hierarchy_.below.of(low), hierarchy_.below.of(high),
      [&](std::uint32_t, std::uint32_t count, std::uint32_t to_low, std::uint32_t to_high) {
        both = least_over(count, rows_below(to_low), rows_below(to_high), both);
        return both == least;
      });
  return both;
}

template <typename Visit>
void HierarchyMetric::for_each_less(const Touched& arc, BothWays bases, const Visit& visit) {
  const auto beside = hierarchy_.above.of(arc.low);
  for_each_shared(
      beside, hierarchy_.above.of(arc.high),
      [&](std::uint32_t first, std::uint32_t count, std::uint32_t over, std::uint32_t target) {
        const std::size_t number = find_less(count, bases, rows(over), rows(target), found_.data());
        for (std::size_t i = 0; i < number; ++i) {
          const std::uint32_t at = found_[i];
          visit(Touched{arc.high, first + at, target + at}, over + at, true);
        }
        return false;
      });
  for_each_shared(
      beside, hierarchy_.below.of(arc.high),
      [&](std::uint32_t first, std::uint32_t count, std::uint32_t over, std::uint32_t target) {
        // Seen from the other end: upwards there is downwards here.
        const auto [up, down] = rows_below(target);
        const std::size_t number = find_less(count, bases, rows(over), {down, up}, found_.data());
        for (std::size_t i = 0; i < number; ++i) {
          const std::uint32_t other = first + found_[i];
          visit(Touched{other, arc.high, hierarchy_.arc_between(other, arc.high)}, over + found_[i],
                false);
        }
        return false;
      });
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
    const BothWays old{up_[next.arc], down_[next.arc]};
    const BothWays now = compute(next.low, next.high, old);
    if (now == old) continue;
    // The way down the arc goes on upwards.
    const BothWays bases{old.down != now.down ? old.down - 1 : kFar,
                         old.up != now.up ? old.up - 1 : kFar};
    for_each_less(next, bases,
                  [&](const Touched& other, std::uint32_t, bool) { touched.push(other); });
    set(next, now);
  }
  return computed;
}

// What has become cheaper is put into the arcs above where it is less.
std::size_t HierarchyMetric::lower(std::span<const std::uint32_t> graph_arcs) {
  std::priority_queue<Touched, std::vector<Touched>, std::greater<>> touched;
  const auto put = [&](const Touched& at, BothWays now) {
    const BothWays less{std::min(up_[at.arc], now.up), std::min(down_[at.arc], now.down)};
    if (less == BothWays{up_[at.arc], down_[at.arc]}) return;
    set(at, less);
    touched.push(at);
  };
  for (const std::uint32_t arc : graph_arcs) {
    const Touched at = place_of(arc);
    const bool upwards = hierarchy_.rank_of_node[graph_.tail[arc]] == at.low;
    const auto weight = static_cast<std::int32_t>(weights_[arc]);
    put(at, upwards ? BothWays{weight, kFar} : BothWays{kFar, weight});
  }
  std::size_t lowered = 0;
  std::uint32_t done = kNoNode;
  while (!touched.empty()) {
    const Touched next = touched.top();
    touched.pop();
    if (next.arc == done) continue;
    done = next.arc;
    ++lowered;
    const BothWays now{up_[next.arc], down_[next.arc]};
    for_each_less(
        next, {now.down, now.up}, [&](const Touched& other, std::uint32_t over, bool next_is_low) {
          const std::int32_t from_next = now.down + up_[over], to_next = now.up + down_[over];
          put(other, next_is_low ? BothWays{from_next, to_next} : BothWays{to_next, from_next});
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
  for_each_shared(
      hierarchy_.below.of(low), hierarchy_.below.of(high),
      [&](std::uint32_t first, std::uint32_t count, std::uint32_t to_low, std::uint32_t to_high) {
        const std::size_t at =
            upwards ? find_sum(count, &down_below_[to_low], &up_below_[to_high], weight)
                    : find_sum(count, &down_below_[to_high], &up_below_[to_low], weight);
        if (at < count) found.arc_or_rank = first + static_cast<std::uint32_t>(at);
        return at < count;
      });
  return found;
}

}  // namespace roadbed::planning::route
