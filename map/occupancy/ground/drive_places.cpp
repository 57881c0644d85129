#include "roadbed/map/occupancy/ground/drive_places.h"

#include <fmt/format.h>

#include <cmath>

#include "roadbed/map/files/input_error.h"

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

void refuse_ground(const Eigen::Vector2d& at, const std::string& found, const std::string& needed) {
  throw map::InputError({.file = "ground",
                         .element = fmt::format("at ({:.1f}, {:.1f})", at.x(), at.y()),
                         .found = found,
                         .needed = needed,
                         .remedy = "give --ground Z, or cut the drive"});
}

double plane_at(const map::GroundPlace& plane, const Eigen::Vector2d& point) {
  return plane.z_m + plane.slope.dot(point - plane.in_source);
}

void check_is_single(const std::vector<map::GroundPlace>& places) {
  constexpr double near_m = 15.0, same_road_m = 0.5;
  constexpr std::size_t step = 4, apart = 40;
  for (std::size_t i = 0; i < places.size(); i += step) {
    for (std::size_t k = i + apart; k < places.size(); k += step) {
      const Eigen::Vector2d middle = 0.5 * (places[i].in_source + places[k].in_source);
      if ((places[k].in_source - places[i].in_source).norm() > near_m) continue;
      const double step_m = std::abs(plane_at(places[i], middle) - plane_at(places[k], middle));
      if (step_m <= same_road_m) continue;
      refuse_ground(places[k].in_source,
                    fmt::format("the drive passes over itself, {:.1f} m apart", step_m),
                    "one height of the ground at each place");
    }
  }
}

}  // namespace roadbed::map::occupancy::ground
