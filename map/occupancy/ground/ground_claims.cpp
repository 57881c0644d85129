#include "roadbed/map/occupancy/ground/drive_ground.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "roadbed/geometry/index/point_index.h"
#include "roadbed/map/occupancy/ground/drive_places.h"

namespace roadbed::map::inline occupancy::inline ground {
namespace {

using Eigen::Vector2d;
using map::GroundPlace;

constexpr double kNearClaim_m = 2.0, kSteepestClaim = 0.5, kStepOfClaim_m = 0.5;

std::string told_at(const Vector2d& at, const std::string& what) {
  return fmt::format("ground: at ({:.1f}, {:.1f}) {}", at.x(), at.y(), what);
}

std::vector<Vector2d> positions_along(const geometry::Trajectory& drive) {
  std::vector<Vector2d> positions;
  for (const geometry::Pose2& pose : places_along(drive)) positions.push_back(pose.position());
  for (const geometry::TrajectoryPoint& sample : drive.points()) {
    positions.push_back(sample.pose().position());
  }
  return positions;
}

double step_between_m(const GroundPlace& a, const GroundPlace& b) {
  const Vector2d middle = 0.5 * (a.in_source + b.in_source);
  return std::abs(plane_at(a, middle) - plane_at(b, middle));
}

std::string step_fault(const std::vector<GroundPlace>& places) {
  std::vector<std::size_t> by_x(places.size());
  for (std::size_t i = 0; i < by_x.size(); ++i) by_x[i] = i;
  std::ranges::sort(by_x, {}, [&](std::size_t i) { return places[i].in_source.x(); });
  for (std::size_t i = 0; i < by_x.size(); ++i) {
    const GroundPlace& place = places[by_x[i]];
    for (std::size_t k = i + 1; k < by_x.size(); ++k) {
      const GroundPlace& next = places[by_x[k]];
      if (next.in_source.x() - place.in_source.x() > kNearClaim_m) break;
      if ((next.in_source - place.in_source).norm() > kNearClaim_m) continue;
      if (step_between_m(place, next) <= kStepOfClaim_m) continue;
      return told_at(next.in_source,
                     fmt::format("it steps by {:.2f} m", step_between_m(place, next)));
    }
  }
  return {};
}

}  // namespace

std::vector<std::string> ground_faults(const map::Ground& ground,
                                       const geometry::Trajectory& drive_in_source,
                                       double reach_m) {
  const std::vector<Vector2d> poses = positions_along(drive_in_source);
  std::vector<Vector2d> at_places;
  for (const GroundPlace& place : ground.places()) at_places.push_back(place.in_source);
  const geometry::PointIndex of_poses(poses), of_places(at_places);
  std::vector<std::string> faults;
  const auto away_m = [](const std::vector<Vector2d>& points, const geometry::PointIndex& index,
                         const Vector2d& at) {
    return (points[index.nearest(at)->index] - at).norm();
  };
  for (const Vector2d& pose : poses) {
    if (away_m(at_places, of_places, pose) <= kNearClaim_m) continue;
    faults.push_back(told_at(pose, fmt::format("nothing is said within {} m", kNearClaim_m)));
    break;
  }
  for (const GroundPlace& place : ground.places()) {
    const bool is_far = away_m(poses, of_poses, place.in_source) > reach_m + kNearClaim_m;
    if (!is_far && place.slope.norm() <= kSteepestClaim) continue;
    faults.push_back(told_at(
        place.in_source,
        is_far ? "it is away from the drive"
               : fmt::format("its slope is {:.2f}, over {}", place.slope.norm(), kSteepestClaim)));
    break;
  }
  if (std::string step = step_fault(ground.places()); !step.empty()) faults.push_back(step);
  return faults;
}

std::pair<double, double> heights_at_samples_m(const map::Ground& ground,
                                               const geometry::Trajectory& drive_in_source) {
  double low_m = std::numeric_limits<double>::infinity(), high_m = -low_m;
  for (const geometry::TrajectoryPoint& sample : drive_in_source.points()) {
    const double z_m = ground.height_m(sample.pose().position());
    low_m = std::min(low_m, z_m);
    high_m = std::max(high_m, z_m);
  }
  return {low_m, high_m};
}

}  // namespace roadbed::map::occupancy::ground
