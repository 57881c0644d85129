// The lateral planner's cycle and its parts; reads as candidate-points per second.
#include <benchmark/benchmark.h>

#include <cmath>

#include "roadbed/planning/lateral/candidate_batch.h"
#include "roadbed/tests/benchmark/planner_scene.h"

namespace {

using namespace roadbed;

// A gentle S of 400 m.
std::vector<Eigen::Vector2d> way_points() {
  std::vector<Eigen::Vector2d> points;
  Eigen::Vector2d at(0, 0);
  double heading = 0.0;
  for (int i = 0; i <= 400; ++i) {
    points.push_back(at);
    if (i >= 60 && i < 260) heading += 0.02 * std::sin((i - 60) / 200.0 * 2.0 * M_PI);
    at += Eigen::Vector2d(std::cos(heading), std::sin(heading));
  }
  return points;
}

void plan_cycle(benchmark::State& state) {
  const benchmark_scene::PlannerScene scene(way_points());
  const auto options = benchmark_scene::options_with(static_cast<int>(state.range(0)));
  const planning::PlanInput input = scene.input();
  for (auto _ : state) {
    benchmark::DoNotOptimize(planning::plan_path(input, geometry::VehicleShape{}, options));
  }
  state.SetItemsProcessed(state.iterations() * state.range(0) * 5396);
}
BENCHMARK(plan_cycle)->Arg(31)->Arg(101)->Unit(benchmark::kMillisecond);

void evaluate_batch(benchmark::State& state) {
  const benchmark_scene::PlannerScene scene(way_points());
  const planning::PlanInput input = scene.input();
  const planning::CycleContext context{.line = input.line,
                                       .start = input.start,
                                       .speed = planning::PlannedSpeed(input.speed),
                                       .previous_d_m = input.previous_d_m,
                                       .half_width_m = 0.8,
                                       .recovery_m = 10.0};
  const auto stations = planning::stations_over(context, 20.0, static_cast<int>(state.range(0)));
  const planning::QuinticFamily family(input.start, 20.0);
  const planning::Grid grid({0.1, -3.5, 3.5, 0.2, 15.0, 30.0});
  const planning::BatchConfig config{.end_d_m = grid.end_d_m(),
                                     .weights = planning::default_weights(),
                                     .frame = {20.0, 30.0, 12.0},
                                     .limits = {0.5, 4.0}};
  for (auto _ : state) {
    benchmark::DoNotOptimize(planning::evaluate_batch(stations, family, config));
  }
  state.SetItemsProcessed(state.iterations() * state.range(0) * 71);
}
BENCHMARK(evaluate_batch)->Arg(31)->Arg(101)->Unit(benchmark::kMicrosecond);

}  // namespace
