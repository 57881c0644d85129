#include "roadbed/tests/benchmark/peak_flops.h"

#include <algorithm>
#include <chrono>

#include "roadbed/geometry/primitives/instruction_sets.h"

namespace roadbed::benchmark_scene {
namespace {

constexpr int kChains = 48, kSteps = 20'000, kTries = 25;

// Independent chains, enough to hide the latency of each.
ROADBED_CLONES double run_chains(double factor, double term) {
  double value[kChains];
  for (int i = 0; i < kChains; ++i) value[i] = 1.0 + 0.01 * i;
  for (int step = 0; step < kSteps; ++step) {
    for (int i = 0; i < kChains; ++i) value[i] = value[i] * factor + term;
  }
  double sum = 0.0;
  for (int i = 0; i < kChains; ++i) sum += value[i];
  return sum;
}

}  // namespace

double peak_gflops() {
  using Clock = std::chrono::steady_clock;
  double most = 0.0;
  for (int i = 0; i < kTries; ++i) {
    const auto begin = Clock::now();
    const volatile double sum = run_chains(0.999 - 1e-9 * i, 1e-3);
    const std::chrono::duration<double> taken = Clock::now() - begin;
    static_cast<void>(sum);
    most = std::max(most, 2e-9 * kChains * kSteps / taken.count());
  }
  return most;
}

}  // namespace roadbed::benchmark_scene
