#pragma once

#include <cstddef>
#include <cstdint>

namespace roadbed::planning {

/// For each i: if base + weight[i] is less than cost[i], puts it there, and `from` in parent[i].
void relax_run(std::size_t count, std::int32_t base, const std::int32_t* weight, std::int32_t* cost,
               std::uint32_t* parent, std::uint32_t from);

/// For each i: cost[i] becomes base + weight[i] if that is less.
void lower_run(std::size_t count, std::int32_t base, const std::int32_t* weight,
               std::int32_t* cost);

}  // namespace roadbed::planning
