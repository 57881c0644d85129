#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "roadbed/planning/hierarchy.h"

namespace roadbed::planning {

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

}  // namespace roadbed::planning
