#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "roadbed/planning/route/hierarchy.h"

namespace roadbed::planning::inline route {

/// For each arc of the runs: if base + its weight is less than the cost of the rank that it leads
/// to, puts it there, and `from` in that rank's parent. Arrays are by arc and by rank.
void relax_row(std::span<const RankRun> runs, std::int32_t base, const std::int32_t* weight,
               std::int32_t* cost, std::uint32_t* parent, std::uint32_t from);

/// The same without parents.
void lower_row(std::span<const RankRun> runs, std::int32_t base, const std::int32_t* weight,
               std::int32_t* cost);

/// For each i: cost[i] becomes base + weight[i] if that is less.
void lower_run(std::size_t count, std::int32_t base, const std::int32_t* weight,
               std::int32_t* cost);

/// Weights of arcs upwards and downwards.
struct BothWays {
  std::int32_t up, down;
  bool operator==(const BothWays&) const = default;
};

/// Weights of arcs to one rank, both ways, beside those to another rank.
struct WeightRows {
  const std::int32_t *up, *down;
};

/// The least way from `low` over one of the ranks to `high`, and back: of down_low[i] + up_high[i],
/// and of down_high[i] + up_low[i]. Not above `least`.
BothWays least_over(std::size_t count, const WeightRows& low, const WeightRows& high,
                    BothWays least);

/// The least i at which a[i] + b[i] is the sum; `count` if there is none.
std::size_t find_sum(std::size_t count, const std::int32_t* a, const std::int32_t* b,
                     std::int32_t sum);

/// Puts into `found` each i at which bases.up + rows.up[i] < now.up[i], or the same for down.
/// @returns  how many there are.
std::size_t find_less(std::size_t count, BothWays bases, const WeightRows& rows,
                      const WeightRows& now, std::uint32_t* found);

}  // namespace roadbed::planning::route
