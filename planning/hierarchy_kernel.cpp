#include "roadbed/planning/hierarchy_kernel.h"

#include <cstring>

#include "roadbed/planning/instruction_sets.h"

namespace roadbed::planning {
namespace {

constexpr std::size_t kWide = 8;
using Wide = std::int32_t __attribute__((vector_size(kWide * sizeof(std::int32_t))));

}  // namespace

// What is left of a run behind whole vectors is done by one that overlaps the last of them: doing
// an arc twice changes nothing.

ROADBED_CLONES void relax_row(std::span<const RankRun> runs, std::int32_t base,
                              const std::int32_t* weight, std::int32_t* cost, std::uint32_t* parent,
                              std::uint32_t from) {
  for (const RankRun& run : runs) {
    const std::int32_t* const w = weight + run.first_arc;
    std::int32_t* const c = cost + run.first;
    std::uint32_t* const p = parent + run.first;
    const std::size_t count = run.count;
    if (count < kWide) {
      for (std::size_t i = 0; i < count; ++i) {
        const std::int32_t other = base + w[i];
        if (other >= c[i]) continue;
        c[i] = other;
        p[i] = from;
      }
      continue;
    }
    for (std::size_t i = 0; i < count; i += kWide) {
      const std::size_t at = i + kWide <= count ? i : count - kWide;
      Wide weights, costs, parents;
      std::memcpy(&weights, w + at, sizeof(Wide));
      std::memcpy(&costs, c + at, sizeof(Wide));
      std::memcpy(&parents, p + at, sizeof(Wide));
      const Wide other = base + weights;
      const Wide better = other < costs;
      costs = better ? other : costs;
      parents = better ? (Wide{} + static_cast<std::int32_t>(from)) : parents;
      std::memcpy(c + at, &costs, sizeof(Wide));
      std::memcpy(p + at, &parents, sizeof(Wide));
    }
  }
}

ROADBED_CLONES void lower_row(std::span<const RankRun> runs, std::int32_t base,
                              const std::int32_t* weight, std::int32_t* cost) {
  for (const RankRun& run : runs) {
    const std::int32_t* const w = weight + run.first_arc;
    std::int32_t* const c = cost + run.first;
    const std::size_t count = run.count;
    if (count < kWide) {
      for (std::size_t i = 0; i < count; ++i) {
        const std::int32_t other = base + w[i];
        c[i] = other < c[i] ? other : c[i];
      }
      continue;
    }
    for (std::size_t i = 0; i < count; i += kWide) {
      const std::size_t at = i + kWide <= count ? i : count - kWide;
      Wide weights, costs;
      std::memcpy(&weights, w + at, sizeof(Wide));
      std::memcpy(&costs, c + at, sizeof(Wide));
      const Wide other = base + weights;
      costs = other < costs ? other : costs;
      std::memcpy(c + at, &costs, sizeof(Wide));
    }
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
