// Import, opening and locating on Town04 of the real data: locate reads as points per second.
// Boost's R-tree answers a simpler question, the nearest centreline segment, for comparison.

#include <benchmark/benchmark.h>

#include <boost/geometry.hpp>
#include <boost/geometry/geometries/point.hpp>
#include <boost/geometry/geometries/segment.hpp>
#include <boost/geometry/index/rtree.hpp>
#include <random>
#include <vector>

#include "roadbed/map/compiled/compiled_map.h"
#include "roadbed/map/derived/conflicts.h"
#include "roadbed/map/derived/surface.h"
#include "roadbed/map/files/read_file.h"
#include "roadbed/map/index/road_map_index.h"
#include "roadbed/map/load_map.h"
#include "roadbed/tests/support/program_run.h"
#include "roadbed/tests/support/real_data.h"

namespace roadbed::map {
namespace {

namespace bg = boost::geometry;
using Point = bg::model::point<double, 2, bg::cs::cartesian>;
using Segment = bg::model::segment<Point>;
using BoostTree = bg::index::rtree<std::pair<Segment, LaneId>, bg::index::quadratic<8>>;

const LaneQuery kNearest{.radius_m = 1000.0, .count = 1};

std::filesystem::path town04() {
  const auto real = tests::real_data_folder();
  return real.empty() ? real : real / "opendrive/BerkeleyLearnVerify+Scenic/Town04.xodr";
}

// Whether the town is there; else the benchmark is skipped.
bool there(benchmark::State& state) {
  if (!town04().empty()) return true;
  state.SkipWithError("no real data: set ROADBED_REAL_DATA to its folder");
  return false;
}

const RoadMap& town() {
  static const RoadMap road_map = load_map(town04());
  return road_map;
}

// At most 50 m beside a lane.
const std::vector<Eigen::Vector2d>& points() {
  static const std::vector<Eigen::Vector2d> made = [] {
    std::mt19937 random(20261121);
    std::uniform_real_distribution<double> fraction(0.0, 1.0), aside(-50.0, 50.0);
    std::vector<Eigen::Vector2d> drawn;
    for (int i = 0; i < 200'000; ++i) {
      const Lane& lane = town().lanes()[random() % town().lanes().size()];
      drawn.emplace_back(lane.pose_at(fraction(random) * lane.length_m()) *
                         Eigen::Vector2d(0.0, aside(random)));
    }
    return drawn;
  }();
  return made;
}

void count_points(benchmark::State& state) {
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(points().size()));
}

void town04_import(benchmark::State& state) {
  if (!there(state)) return;
  for (auto _ : state) {
    benchmark::DoNotOptimize(write_compiled_map(parse_map(read_file(town04()), "Town04.xodr")));
  }
}
BENCHMARK(town04_import)->Unit(benchmark::kMillisecond);

void town04_open(benchmark::State& state) {
  if (!there(state)) return;
  const tests::TemporaryFolder folder;
  const std::filesystem::path file = folder.write("town.rbm", write_compiled_map(town()));
  for (auto _ : state) benchmark::DoNotOptimize(open_compiled_map(file));
}
BENCHMARK(town04_open)->Unit(benchmark::kMillisecond);

void town04_open_and_locate_first(benchmark::State& state) {
  if (!there(state)) return;
  const tests::TemporaryFolder folder;
  const std::filesystem::path file = folder.write("town.rbm", write_compiled_map(town()));
  std::size_t i = 0;
  for (auto _ : state) {
    const RoadMap road_map = open_compiled_map(file);
    benchmark::DoNotOptimize(road_map.index().lanes.near(points()[i], kNearest));
    i = (i + 7) % points().size();
  }
}
BENCHMARK(town04_open_and_locate_first)->Unit(benchmark::kMillisecond);

void town04_surfaces(benchmark::State& state) {
  if (!there(state)) return;
  for (auto _ : state) {
    benchmark::DoNotOptimize(drivable_surface(town()));
    for (const Road& road : town().roads()) {
      benchmark::DoNotOptimize(road_surface(town(), road.id));
    }
    for (const Junction& junction : town().junctions()) {
      benchmark::DoNotOptimize(junction_surface(town(), junction.id));
    }
  }
}
BENCHMARK(town04_surfaces)->Unit(benchmark::kMillisecond);

void town04_conflicts(benchmark::State& state) {
  if (!there(state)) return;
  for (auto _ : state) benchmark::DoNotOptimize(find_conflicts(town()));
}
BENCHMARK(town04_conflicts)->Unit(benchmark::kMillisecond);

void town04_locate_one_by_one(benchmark::State& state) {
  if (!there(state)) return;
  for (auto _ : state) {
    for (const Eigen::Vector2d& point : points()) {
      benchmark::DoNotOptimize(town().index().lanes.near(point, kNearest));
    }
  }
  count_points(state);
}
BENCHMARK(town04_locate_one_by_one)->Unit(benchmark::kMillisecond);

void town04_locate_batch(benchmark::State& state) {
  if (!there(state)) return;
  for (auto _ : state) benchmark::DoNotOptimize(town().index().lanes.near(points(), kNearest));
  count_points(state);
}
BENCHMARK(town04_locate_batch)->Unit(benchmark::kMillisecond);

void town04_locate_batch_in_compiled_map(benchmark::State& state) {
  if (!there(state)) return;
  const RoadMap compiled = read_compiled_map(write_compiled_map(town()), "town.rbm");
  for (auto _ : state) benchmark::DoNotOptimize(compiled.index().lanes.near(points(), kNearest));
  count_points(state);
}
BENCHMARK(town04_locate_batch_in_compiled_map)->Unit(benchmark::kMillisecond);

void town04_boost_nearest_segment(benchmark::State& state) {
  if (!there(state)) return;
  std::vector<std::pair<Segment, LaneId>> segments;
  for (const Lane& lane : town().lanes()) {
    const auto& line = lane.centre.in_map.points();
    for (std::size_t i = 1; i < line.size(); ++i) {
      segments.emplace_back(
          Segment(Point(line[i - 1].x(), line[i - 1].y()), Point(line[i].x(), line[i].y())),
          lane.id);
    }
  }
  const BoostTree tree(segments);
  for (auto _ : state) {
    for (const Eigen::Vector2d& point : points()) {
      std::vector<std::pair<Segment, LaneId>> found;
      tree.query(bg::index::nearest(Point(point.x(), point.y()), 1), std::back_inserter(found));
      benchmark::DoNotOptimize(found);
    }
  }
  count_points(state);
}
BENCHMARK(town04_boost_nearest_segment)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace roadbed::map
