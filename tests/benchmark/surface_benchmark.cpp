// Audits of drives along the lanes of Town04 against the edge of its drivable surface: rows per
// second, so many centimetres apart, with the surface made; and making it.

#include <benchmark/benchmark.h>

#include <vector>

#include "roadbed/map/load_map.h"
#include "roadbed/planning/audit/surface/surface_audit.h"
#include "roadbed/planning/audit/swept_drive.h"
#include "roadbed/tests/support/real_data.h"

namespace roadbed::planning {
namespace {

const geometry::BodyPart kBody = geometry::body_of({});

// The town's lanes, one after the other, each driven by itself.
struct Town {
  map::RoadMap road_map;
  RoadSurface surface;

  explicit Town(const std::filesystem::path& file) : road_map(map::load_map(file)) {
    std::vector<geometry::Polygon> polygons;
    for (const map::Lane& lane : road_map.lanes()) {
      if (!map::is_drivable(lane.type)) continue;
      geometry::Ring ring = lane.polygon;
      for (Eigen::Vector2d& point : ring) point = road_map.to_source(point);
      if (ring.size() > 2) polygons.push_back({ring, {}});
    }
    surface = road_surface(polygons, SurfaceRule{}.seam_m);
  }

  std::vector<geometry::Trajectory> drives(double step_m) const {
    std::vector<geometry::Trajectory> drives;
    for (const map::Lane& lane : road_map.lanes()) {
      if (!map::is_drivable(lane.type) || lane.length_m() < 20.0) continue;
      const auto pose_at = [&](double s_m) {
        const geometry::Pose2 pose = lane.pose_at(s_m);
        const Eigen::Vector2d at = road_map.to_source(pose.position());
        return geometry::Pose2{at.x(), at.y(), pose.heading_rad};
      };
      drives.push_back(swept_along(pose_at, lane.length_m(), {.step_m = step_m}));
    }
    return drives;
  }
};

const Town* town(benchmark::State& state) {
  const auto real = tests::real_data_folder();
  if (real.empty()) {
    state.SkipWithError("no real data: set ROADBED_REAL_DATA to its folder");
    return nullptr;
  }
  static const Town made(real / "opendrive/BerkeleyLearnVerify+Scenic/Town04.xodr");
  return &made;
}

void audit_lanes_of_town04(benchmark::State& state) {
  const Town* of = town(state);
  if (of == nullptr) return;
  const auto drives = of->drives(0.01 * static_cast<double>(state.range(0)));
  std::size_t rows = 0;
  for (const geometry::Trajectory& drive : drives) rows += drive.points().size();
  for (auto _ : state) {
    for (const geometry::Trajectory& drive : drives) {
      benchmark::DoNotOptimize(audit_surface(of->surface, drive, {&kBody, 1}, 0.0));
    }
  }
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(rows));
}
BENCHMARK(audit_lanes_of_town04)->Arg(10)->Arg(50)->Unit(benchmark::kMillisecond);

void make_surface_around_a_lane(benchmark::State& state) {
  const Town* of = town(state);
  if (of == nullptr) return;
  const SurfaceRule rule{.road_map = &of->road_map};
  const auto drives = of->drives(0.5);
  std::size_t next = 0;
  for (auto _ : state) {
    const geometry::Trajectory& drive = drives[next++ % drives.size()];
    benchmark::DoNotOptimize(
        road_surface(surface_polygons(rule, drive, kBody.reach_m()), rule.seam_m));
  }
}
BENCHMARK(make_surface_around_a_lane)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace roadbed::planning
