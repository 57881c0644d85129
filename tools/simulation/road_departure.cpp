#include "roadbed/tools/simulation/road_departure.h"

#include <algorithm>

#include "roadbed/planning/audit/surface/farthest_off.h"
#include "roadbed/planning/audit/surface/surface_audit.h"

namespace roadbed::tools::inline simulation {
namespace {

// Town04 has gaps of 6 mm between connecting lanes. Edges count as drawn within a centimetre.
constexpr double kSeam_m = 0.02, kOverEdge_m = 0.01, kPointsApart_m = 0.25;

std::size_t row_at(const Drive& drive, double t_s) {
  const auto next = std::ranges::upper_bound(drive.samples, t_s, {}, &DriveSample::t_s);
  return next == drive.samples.begin() ? 0
                                       : static_cast<std::size_t>(next - drive.samples.begin()) - 1;
}

}  // namespace

std::optional<RoadDeparture> judge_road(const map::RoadMap& road_map,
                                        const geometry::VehicleShape& vehicle, Drive& drive) {
  const geometry::BodyPart body = geometry::body_of(vehicle);
  const geometry::BodyPart within = geometry::inflated(body, -kOverEdge_m);
  const planning::RoadSurface surface = planning::road_surface(
      planning::surface_polygons(
          {.kind = planning::SurfaceRule::Kind::surface, .road_map = &road_map}, drive.trajectory,
          body.reach_m()),
      kSeam_m);
  const planning::SurfaceReport report =
      planning::audit_surface(surface, drive.trajectory, {&within, 1}, 0.0);
  const auto off_m = [&](const geometry::TrajectoryPoint& at) {
    return planning::farthest_off(surface.edges, body, at.pose(), kPointsApart_m).depth_m;
  };
  std::optional<RoadDeparture> worst;
  for (const planning::Excursion& out : report.conflicts) {
    if (out.depth_m <= 0.0) continue;
    for (std::size_t i = row_at(drive, out.from_s); i <= row_at(drive, out.to_s); ++i) {
      const geometry::TrajectoryPoint& row = drive.trajectory.points()[i];
      if (row.t_s >= out.from_s) drive.samples[i].off_road_m = off_m(row);
    }
    DriveSample& at = drive.samples[row_at(drive, out.at.t_s)];
    at.off_road_m = std::max(at.off_road_m, off_m(out.at));
    const bool begins_there = out.from_s <= drive.trajectory.start_s();
    if (begins_there || off_m(out.at) <= (worst ? worst->off_m : 0.0)) continue;
    worst = {.off_m = off_m(out.at), .at_s = out.at.t_s};
  }
  return worst;
}

}  // namespace roadbed::tools::simulation
