// Import reads as bytes of OpenDRIVE per second, locate as points per second.

#include <benchmark/benchmark.h>

#include <random>
#include <vector>

#include "roadbed/map/compiled/compiled_map.h"
#include "roadbed/map/files/read_file.h"
#include "roadbed/map/load_map.h"
#include "roadbed/tests/support/real_data.h"

namespace roadbed::map {
namespace {

void import_town(benchmark::State& state) {
  const std::string bytes = read_file(tests::data_folder() / "town.xodr");
  for (auto _ : state) benchmark::DoNotOptimize(parse_map(bytes, "town.xodr"));
  state.SetBytesProcessed(state.iterations() * static_cast<std::int64_t>(bytes.size()));
}
BENCHMARK(import_town)->Unit(benchmark::kMillisecond);

void open_compiled_town(benchmark::State& state) {
  const std::string bytes = write_compiled_map(load_map(tests::data_folder() / "town.xodr"));
  for (auto _ : state) benchmark::DoNotOptimize(read_compiled_map(bytes, "town.rbm"));
  state.SetBytesProcessed(state.iterations() * static_cast<std::int64_t>(bytes.size()));
}
BENCHMARK(open_compiled_town)->Unit(benchmark::kMillisecond);

void locate_on_town(benchmark::State& state) {
  const RoadMap town = load_map(tests::data_folder() / "town.xodr");
  std::mt19937 random(20261121);
  std::uniform_real_distribution<double> fraction(0.0, 1.0), aside(-20.0, 20.0);
  std::vector<Eigen::Vector2d> points;
  for (int i = 0; i < 1000; ++i) {
    const Lane& lane = town.lanes()[random() % town.lanes().size()];
    points.emplace_back(lane.pose_at(fraction(random) * lane.length_m()) *
                        Eigen::Vector2d(0.0, aside(random)));
  }
  for (auto _ : state) {
    for (const Eigen::Vector2d& point : points) {
      benchmark::DoNotOptimize(town.locate(point, 10.0, false));
    }
  }
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(points.size()));
}
BENCHMARK(locate_on_town)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace roadbed::map
