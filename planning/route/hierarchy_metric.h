#pragma once

#include <cstdint>
#include <span>
#include <tuple>
#include <vector>

#include "roadbed/planning/route/hierarchy.h"
#include "roadbed/planning/route/hierarchy_kernel.h"

namespace roadbed::planning::inline route {

/// `kNever` as the kernels compare it.
inline constexpr auto kFar = static_cast<std::int32_t>(kNever);

/// Weights of a hierarchy's arcs, for both directions.
class HierarchyMetric {
 public:
  /// Customisation: every arc becomes as cheap as the way over lower nodes. Refers to its
  /// arguments but the weights. O(triangles).
  HierarchyMetric(const RouteGraph& graph, const Hierarchy& hierarchy,
                  std::span<const Ticks> weights);

  /// Arcs of the graph have got other weights. Only what they touch is computed again.
  /// @returns  how many arcs of the hierarchy that were.
  std::size_t change(std::span<const std::uint32_t> graph_arcs, std::span<const Ticks> weights);

  const Hierarchy& hierarchy() const { return hierarchy_; }
  const RouteGraph& graph() const { return graph_; }
  const std::vector<Ticks>& weights() const { return weights_; }
  const std::vector<std::int32_t>& up() const { return up_; }
  const std::vector<std::int32_t>& down() const { return down_; }

  /// What an arc of the hierarchy stands for: an arc of the graph, or two of the hierarchy over a
  /// lower rank.
  struct Meaning {
    bool is_arc = false;
    std::uint32_t arc_or_rank = kNoNode;
  };
  Meaning meaning(std::uint32_t low, std::uint32_t high, bool upwards) const;

  /// Grows with every change().
  std::uint64_t version() const { return version_; }

 private:
  /// An arc of the hierarchy whose weights may change; lower ones come first.
  struct Touched {
    std::uint32_t low, high, arc;
    bool operator>(const Touched& other) const {
      return std::tie(low, high) > std::tie(other.low, other.high);
    }
  };
  void customise(std::uint32_t rank);
  void turn();
  WeightRows rows(std::uint32_t arc) const { return {&up_[arc], &down_[arc]}; }
  WeightRows rows_below(std::uint32_t place) const {
    return {&up_below_[place], &down_below_[place]};
  }
  void set(const Touched& arc, BothWays weights);
  std::int32_t own_weight(std::uint32_t from, std::uint32_t to) const;
  BothWays compute(std::uint32_t low, std::uint32_t high, const BothWays& least) const;
  Touched place_of(std::uint32_t graph_arc) const;
  /// Visits arcs that lead up or down from the arc's higher rank, and are part of a triangle with
  /// it over its lower one, where the way over that costs less than they do if the arc costs
  /// `bases`: the arc, the weights of the way on from the lower rank, whether the higher rank is
  /// the lower one there.
  template <typename Visit>
  void for_each_less(const Touched& arc, BothWays bases, const Visit& visit);
  std::size_t raise(std::span<const std::uint32_t> graph_arcs);
  std::size_t lower(std::span<const std::uint32_t> graph_arcs);

  const RouteGraph& graph_;
  const Hierarchy& hierarchy_;
  std::vector<Ticks> weights_;
  std::vector<std::int32_t> up_, down_;              ///< by arc
  std::vector<std::int32_t> up_below_, down_below_;  ///< the same by second place
  std::vector<std::uint32_t> found_;
  std::uint64_t version_ = 0;
};

}  // namespace roadbed::planning::route
