#include <benchmark/benchmark.h>

#include <cmath>
#include <vector>

#include "roadbed/geometry/curves/spline_curve.h"

namespace {

using namespace roadbed;

// A winding road of 10 km with a way-point about every 10 m, resampled as in the paper's Fig. 4.
void resample_10_km_at_1_cm(benchmark::State& state) {
  std::vector<Eigen::Vector2d> points;
  double heading = 0.0, length_m = 0.0;
  for (int i = 0; length_m < 10'000.0; ++i) {
    const double gap_m = 10.0 + 3.0 * std::sin(0.7 * i);
    heading += 0.15 * std::sin(0.11 * i);
    const Eigen::Vector2d last = points.empty() ? Eigen::Vector2d(0.0, 0.0) : points.back();
    points.push_back(last + gap_m * Eigen::Vector2d(std::cos(heading), std::sin(heading)));
    length_m += gap_m;
  }
  const auto curve = geometry::SplineCurve::through(points);
  for (auto _ : state) benchmark::DoNotOptimize(curve.resample(0.01));
  state.counters["points"] = static_cast<double>(curve.resample(0.01).size());
}
BENCHMARK(resample_10_km_at_1_cm)->Unit(benchmark::kMillisecond);

}  // namespace
