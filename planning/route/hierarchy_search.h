#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "roadbed/planning/route/hierarchy_metric.h"

namespace roadbed::planning::inline route {

/// What one side of a search has seen: the ranks on the way up from its seeds, ascending, and what
/// it costs to get there (or on from there).
struct ClimbedSpace {
  std::vector<std::uint32_t> ranks;
  std::vector<std::int32_t> costs;
};

/// Searches a customised hierarchy along its elimination tree: every rank that can matter lies on
/// the way from a seed to the root, so there is no queue. Once the ways up from both sides have
/// become one, a rank is only looked at further if what it cost so far, and the least that any rank
/// ahead costs the other side, are less than the best way known. Keeps its working memory; one per
/// thread.
class HierarchySearch {
 public:
  explicit HierarchySearch(const HierarchyMetric& metric);

  /// As GraphSearch::find().
  GraphPath find(std::span<const Seed> from, std::span<const Seed> to);

  /// Just its cost.
  Ticks cost(std::span<const Seed> from, std::span<const Seed> to);

  /// One side for many pairs; see cost_between.
  ClimbedSpace climb(std::span<const Seed> seeds, bool backward);

 private:
  struct Side {
    std::vector<std::int32_t> cost;
    std::vector<std::uint32_t> parent;  ///< rank, or seed with kSeedBit
    std::vector<std::uint32_t> open;    ///< where its ways up stand, lowest last
  };
  struct Meeting {
    std::int32_t cost;
    std::uint32_t rank = 0;
  };
  static constexpr std::uint32_t kSeedBit = 1U << 31;
  /// Ranks after so many of them ask anew how little what is ahead can cost.
  static constexpr std::size_t kStride = 64;
  /// What was found out about arcs of the hierarchy: each has one place, and pushes out others.
  struct Known {
    std::uint32_t low = kNoNode, high = kNoNode;
    bool upwards = false;
    HierarchyMetric::Meaning meaning;
  };
  static constexpr std::size_t kKnown = 1U << 14;

  void start(Side& side, std::span<const Seed> seeds) const;
  void step(Side& side, std::uint32_t rank) const;
  template <bool kTraced>
  void relax(Side& side, const std::vector<std::int32_t>& weights, std::uint32_t rank) const;
  template <bool kTraced>
  Meeting meet(std::span<const Seed> from, std::span<const Seed> to);
  bool have_met() const;
  template <bool kTraced>
  Meeting climb_together(Meeting best);
  BothWays least_ahead(std::span<const std::uint32_t> ranks, Meeting& best) const;
  void clear();
  HierarchyMetric::Meaning meaning(std::uint32_t low, std::uint32_t high, bool upwards);
  void unpack(std::uint32_t low, std::uint32_t high, bool upwards,
              std::vector<std::uint32_t>& arcs);
  std::uint32_t seed_of(const Side& side, std::uint32_t rank,
                        std::vector<std::uint32_t>& chain) const;

  const HierarchyMetric& metric_;
  Side forward_, backward_;
  std::vector<std::uint32_t> visited_;
  std::vector<Known> known_;
  std::uint64_t known_version_ = 0;
};

/// Least cost between what a forward and a backward climb have seen. O(ranks of both).
Ticks cost_between(const ClimbedSpace& forward, const ClimbedSpace& backward);

}  // namespace roadbed::planning::route
