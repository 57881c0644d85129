// Building reads as points per second, the field as occupied and free cells per second, the audit
// as metres of a drive per second.

#include <benchmark/benchmark.h>

#include <algorithm>
#include <filesystem>
#include <vector>

#include "roadbed/map/occupancy/clearance/clearance_field.h"
#include "roadbed/map/occupancy/clouds/read_point_cloud.h"
#include "roadbed/map/occupancy/octree/occupancy_map.h"
#include "roadbed/planning/audit/clearance_audit.h"
#include "roadbed/tests/support/real_data.h"

namespace roadbed {
namespace {

std::vector<map::PointCloud> town_scans() {
  std::vector<std::filesystem::path> files;
  for (const auto& entry : std::filesystem::directory_iterator(tests::data_folder() / "scans")) {
    if (entry.path().extension() == ".pcd") files.push_back(entry.path());
  }
  std::sort(files.begin(), files.end());
  std::vector<map::PointCloud> clouds;
  for (const auto& file : files) clouds.push_back(map::read_point_cloud(file));
  return clouds;
}

map::OccupancyMap town_occupancy() {
  return map::OccupancyMap::build(town_scans(), {.resolution_m = 0.2});
}

void build_occupancy(benchmark::State& state) {
  const std::vector<map::PointCloud> clouds = town_scans();
  std::int64_t points = 0;
  for (const map::PointCloud& cloud : clouds) {
    points += static_cast<std::int64_t>(cloud.points.size());
  }
  for (auto _ : state) {
    benchmark::DoNotOptimize(map::OccupancyMap::build(clouds, {.resolution_m = 0.2}));
  }
  state.SetItemsProcessed(state.iterations() * points);
}
BENCHMARK(build_occupancy)->Unit(benchmark::kMillisecond);

void make_clearance_field(benchmark::State& state) {
  const map::OccupancyMap occupancy = town_occupancy();
  for (auto _ : state) {
    benchmark::DoNotOptimize(map::ClearanceField(occupancy, map::HeightBand{}));
  }
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(occupancy.node_count()));
}
BENCHMARK(make_clearance_field)->Unit(benchmark::kMillisecond);

void audit_main_street(benchmark::State& state) {
  const map::OccupancyMap occupancy = town_occupancy();
  const map::ClearanceField field(occupancy, map::HeightBand{});
  // 90 m along Main Street of data/town.xodr, a row every metre.
  std::vector<geometry::TrajectoryPoint> rows;
  for (int i = 0; i <= 90; ++i) {
    rows.push_back({.t_s = 0.1 * i, .x_m = 110.0 + i, .y_m = 198.25, .speed_mps = 10.0});
  }
  const geometry::Trajectory drive(rows);
  for (auto _ : state) {
    benchmark::DoNotOptimize(planning::audit_clearance(field, drive, geometry::VehicleShape{}));
  }
  state.SetItemsProcessed(state.iterations() * 90);
}
BENCHMARK(audit_main_street)->Unit(benchmark::kMicrosecond);

}  // namespace
}  // namespace roadbed
