// Audits of drives along the lanes of Town04 against the edge of its drivable surface: rows per
// second, 0.5 m apart, with the surface made, and making it.

#include <benchmark/benchmark.h>

#include <vector>

#include "roadbed/map/load_map.h"
#include "roadbed/planning/audit/surface_audit.h"
#include "roadbed/planning/audit/swept_drive.h"
#include "roadbed/tests/support/real_data.h"

namespace roadbed::planning {
namespace {

const geometry::BodyPart kBody = geometry::body_of({});

// The town's lanes, one after the other, each driven by itself.
struct Town {
  map::RoadMap road_map;
  std::vector<geometry::Trajectory> drives;
  RoadSurface surface;
  std::size_t rows = 0;

  explicit Town(const std::filesystem::path& file) : road_map(map::load_map(file)) {
    std::vector<geometry::Polygon> polygons;
    for (const map::Lane& lane : road_map.lanes()) {
      if (!map::is_drivable(lane.type)) continue;
      geometry::Ring ring = lane.polygon;
      for (Eigen::Vector2d& point : ring) point = road_map.to_source(point);
      if (ring.size() > 2) polygons.push_back({ring, {}});
      if (lane.length_m() < 20.0) continue;
      drives.push_back(swept_along(
          [&](double s_m) {
            const geometry::Pose2 pose = lane.pose_at(s_m);
            const Eigen::Vector2d at = road_map.to_source(pose.position());
            return geometry::Pose2{at.x(), at.y(), pose.heading_rad};
          },
          lane.length_m()));
      rows += drives.back().points().size();
    }
    surface = road_surface(polygons, SurfaceRule{}.seam_m);
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
  for (auto _ : state) {
    for (const geometry::Trajectory& drive : of->drives) {
      benchmark::DoNotOptimize(audit_surface(of->surface, drive, {&kBody, 1}, 0.0));
    }
  }
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(of->rows));
}
BENCHMARK(audit_lanes_of_town04)->Unit(benchmark::kMillisecond);

void make_surface_around_a_lane(benchmark::State& state) {
  const Town* of = town(state);
  if (of == nullptr) return;
  const SurfaceRule rule{.road_map = &of->road_map};
  std::size_t next = 0;
  for (auto _ : state) {
    const geometry::Trajectory& drive = of->drives[next++ % of->drives.size()];
    benchmark::DoNotOptimize(
        road_surface(surface_polygons(rule, drive, kBody.reach_m()), rule.seam_m));
  }
}
BENCHMARK(make_surface_around_a_lane)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace roadbed::planning
