#include "roadbed/planning/route/hierarchy_kernel.h"

#include <cstring>

#include "roadbed/geometry/primitives/instruction_sets.h"

namespace roadbed::planning::inline route {
namespace {

constexpr std::size_t kWide = 8;
using Wide = std::int32_t __attribute__((vector_size(kWide * sizeof(std::int32_t))));

inline void load(Wide& wide, const std::int32_t* from) { std::memcpy(&wide, from, sizeof(Wide)); }

inline bool any(const Wide& mask) {
  std::uint64_t parts[sizeof(Wide) / sizeof(std::uint64_t)];
  std::memcpy(parts, &mask, sizeof(Wide));
  return (parts[0] | parts[1] | parts[2] | parts[3]) != 0;
}

inline std::int32_t least_of(const Wide& wide) {
  std::int32_t least = wide[0];
  for (std::size_t i = 1; i < kWide; ++i) least = wide[i] < least ? wide[i] : least;
  return least;
}

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

ROADBED_CLONES BothWays least_over(std::size_t count, const WeightRows& low, const WeightRows& high,
                                   BothWays least) {
  if (count < kWide) {
    for (std::size_t i = 0; i < count; ++i) {
      const std::int32_t up = low.down[i] + high.up[i], down = high.down[i] + low.up[i];
      least = {up < least.up ? up : least.up, down < least.down ? down : least.down};
    }
    return least;
  }
  Wide up = Wide{} + least.up, down = Wide{} + least.down;
  for (std::size_t i = 0; i < count; i += kWide) {
    const std::size_t at = i + kWide <= count ? i : count - kWide;
    Wide low_up, low_down, high_up, high_down;
    load(low_up, low.up + at);
    load(low_down, low.down + at);
    load(high_up, high.up + at);
    load(high_down, high.down + at);
    const Wide way_up = low_down + high_up, way_down = high_down + low_up;
    up = way_up < up ? way_up : up;
    down = way_down < down ? way_down : down;
  }
  return {least_of(up), least_of(down)};
}

ROADBED_CLONES std::size_t find_sum(std::size_t count, const std::int32_t* a, const std::int32_t* b,
                                    std::int32_t sum) {
  std::size_t i = 0;
  for (; i + kWide <= count; i += kWide) {
    Wide one, other;
    load(one, a + i);
    load(other, b + i);
    if (any(one + other == sum)) break;
  }
  while (i < count && a[i] + b[i] != sum) ++i;
  return i;
}

ROADBED_CLONES std::size_t find_less(std::size_t count, BothWays bases, const WeightRows& rows,
                                     const WeightRows& now, std::uint32_t* found) {
  const auto is_less = [&](std::size_t i) {
    return bases.up + rows.up[i] < now.up[i] || bases.down + rows.down[i] < now.down[i];
  };
  std::size_t number = 0, i = 0;
  for (; i + kWide <= count; i += kWide) {
    Wide up, down, now_up, now_down;
    load(up, rows.up + i);
    load(down, rows.down + i);
    load(now_up, now.up + i);
    load(now_down, now.down + i);
    if (!any((bases.up + up < now_up) | (bases.down + down < now_down))) continue;
    for (std::size_t j = i; j < i + kWide; ++j) {
      if (is_less(j)) found[number++] = static_cast<std::uint32_t>(j);
    }
  }
  for (; i < count; ++i) {
    if (is_less(i)) found[number++] = static_cast<std::uint32_t>(i);
  }
  return number;
}

}  // namespace roadbed::planning::route
