// Reads as points of the input per second.

#include <benchmark/benchmark.h>

#include <cmath>
#include <vector>

#include "roadbed/geometry/polygons/polygon.h"

namespace roadbed::geometry {
namespace {

/// Rings of roads, 7 m wide, with `points` corners together: circles of 50 m radius whose centres
/// are 60 m apart, so that each crosses the next one four times.
std::vector<Polygon> chain_of_rings(int points) {
  constexpr int kRings = 20;
  const int per_border = points / (2 * kRings);
  std::vector<Polygon> rings;
  for (int k = 0; k < kRings; ++k) {
    Polygon ring;
    ring.holes.emplace_back();
    for (int i = 0; i < per_border; ++i) {
      const double angle_rad = 6.283185307179586 * i / per_border;
      const Eigen::Vector2d outwards(std::cos(angle_rad), std::sin(angle_rad));
      const Eigen::Vector2d centre(60.0 * k, 0.0);
      ring.outer.emplace_back(centre + 53.5 * outwards);
      ring.holes[0].insert(ring.holes[0].begin(), Eigen::Vector2d(centre + 46.5 * outwards));
    }
    rings.push_back(ring);
  }
  return rings;
}

void unite_roads(benchmark::State& state) {
  const auto rings = chain_of_rings(static_cast<int>(state.range(0)));
  for (auto _ : state) benchmark::DoNotOptimize(unite(rings, 1e-3));
  state.SetItemsProcessed(state.iterations() * state.range(0));
}
BENCHMARK(unite_roads)->RangeMultiplier(10)->Range(400, 40'000)->Unit(benchmark::kMillisecond);

void check_simplicity(benchmark::State& state) {
  const Ring ring = chain_of_rings(static_cast<int>(state.range(0)) * 40).front().outer;
  for (auto _ : state) benchmark::DoNotOptimize(is_simple(ring));
  state.SetItemsProcessed(state.iterations() * state.range(0));
}
BENCHMARK(check_simplicity)->RangeMultiplier(10)->Range(10, 10'000);

}  // namespace
}  // namespace roadbed::geometry
