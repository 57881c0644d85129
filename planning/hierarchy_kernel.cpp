#include "roadbed/planning/hierarchy_kernel.h"

#include "roadbed/planning/instruction_sets.h"

namespace roadbed::planning {

ROADBED_CLONES void relax_run(std::size_t count, std::int32_t base,
                              const std::int32_t* __restrict weight, std::int32_t* __restrict cost,
                              std::uint32_t* __restrict parent, std::uint32_t from) {
  for (std::size_t i = 0; i < count; ++i) {
    const std::int32_t other = base + weight[i];
    const bool better = other < cost[i];
    cost[i] = better ? other : cost[i];
    parent[i] = better ? from : parent[i];
  }
}

ROADBED_CLONES void lower_run(std::size_t count, std::int32_t base,
                              const std::int32_t* __restrict weight,
                              std::int32_t* __restrict cost) {
  for (std::size_t i = 0; i < count; ++i) {
    const std::int32_t other = base + weight[i];
    cost[i] = other < cost[i] ? other : cost[i];
  }
}

}  // namespace roadbed::planning
