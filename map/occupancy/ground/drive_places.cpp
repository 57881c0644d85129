#include "roadbed/map/occupancy/ground/drive_places.h"

#include <cmath>

namespace roadbed::map::inline occupancy::inline ground {

std::vector<geometry::Pose2> places_along(const geometry::Trajectory& drive) {
  constexpr double apart_m = 1.0;
  const auto& samples = drive.points();
  std::vector<geometry::Pose2> places{samples.front().pose()};
  for (std::size_t i = 1; i < samples.size(); ++i) {
    const geometry::Pose2 from = samples[i - 1].pose(), to = samples[i].pose();
    const Eigen::Vector2d way = to.position() - from.position();
    double left_m = way.norm();
    while ((to.position() - places.back().position()).norm() > apart_m && left_m > apart_m) {
      left_m -= apart_m;
      const Eigen::Vector2d point = to.position() - left_m / way.norm() * way;
      places.push_back({point.x(), point.y(), to.heading_rad});
    }
    const bool is_last = i + 1 == samples.size();
    if (is_last || (to.position() - places.back().position()).norm() > 0.5 * apart_m) {
      places.push_back(to);
    }
  }
  return places;
}

}  // namespace roadbed::map::occupancy::ground
