#include "roadbed/planning/speed/path_profile.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace roadbed::planning::inline speed {
namespace {

constexpr double kFine_m = 0.5, kWayStep_m = 1.0, kFineUntil_m = 40.0;
constexpr double kFastest_mps = 60.0;
constexpr double kSurfaceSlack_m = 0.01;  // lanes of real files do not meet exactly

double bend_speed_mps(double curvature_per_m, double curvature_d1_per_m2,
                      const geometry::VehicleShape& vehicle, const BendLimits& limits) {
  const double by_acceleration =
      std::sqrt(limits.max_lateral_acceleration_mps2 / std::max(1e-6, std::abs(curvature_per_m)));
  const double turn = vehicle.wheelbase_m * curvature_per_m;
  const double steering_per_m =
      vehicle.wheelbase_m * std::abs(curvature_d1_per_m2) / (1.0 + turn * turn);  // of atan(L k)
  const double rate = limits.steering_rate_fraction * vehicle.max_steering_rate_radps;
  return std::min({kFastest_mps, by_acceleration, rate / std::max(1e-6, steering_per_m)});
}

bool is_on_road(const geometry::Rectangle& body, const map::RoadMap& road_map) {
  return std::ranges::all_of(body.corners(), [&](const Eigen::Vector2d& corner) {
    return road_map.on_surface(corner, kSurfaceSlack_m);
  });
}

}  // namespace

std::size_t PathProfile::before(double distance_m) const {
  const auto after = std::upper_bound(ahead_m.begin(), ahead_m.end(), distance_m);
  return after == ahead_m.begin() ? 0 : static_cast<std::size_t>(after - ahead_m.begin() - 1);
}

double PathProfile::ahead_of_m(double s_m) const {
  if (!std::isfinite(s_m)) return s_m;
  if (s_m >= station_m.back()) return ahead_m.back() + s_m - station_m.back();
  if (s_m <= station_m.front()) return s_m - station_m.front();
  const auto after = std::upper_bound(station_m.begin(), station_m.end(), s_m);
  const auto i = static_cast<std::size_t>(after - station_m.begin());
  const double fraction = (s_m - station_m[i - 1]) / (station_m[i] - station_m[i - 1]);
  return ahead_m[i - 1] + fraction * (ahead_m[i] - ahead_m[i - 1]);
}

PathProfile sample_path_profile(const PlannedPath& path, double from_s_m, double length_m,
                                const SpeedCeiling& ceiling, const geometry::VehicleShape& vehicle,
                                const BendLimits& limits) {
  PathProfile profile;
  Eigen::Vector2d last(0.0, 0.0);
  for (double l_m = 0.0; l_m <= length_m; l_m += l_m < kFineUntil_m ? kFine_m : kWayStep_m) {
    const PlannedPath::Place place = path.place_at(from_s_m + l_m);
    const Eigen::Vector2d here = place.pose.position();
    const double ahead_m =
        profile.ahead_m.empty() ? 0.0 : profile.ahead_m.back() + (here - last).norm();
    last = here;
    profile.ahead_m.push_back(ahead_m);
    profile.station_m.push_back(from_s_m + l_m);
    profile.body.push_back(geometry::body_at(place.pose, vehicle));
    profile.wanted_mps.push_back(ceiling.at(from_s_m + l_m).speed_mps);
    profile.curvature_per_m.push_back(place.curvature_per_m);
  }
  limit_speed_in_bends(profile, vehicle, limits);
  return profile;
}

void limit_speed_in_bends(PathProfile& profile, const geometry::VehicleShape& vehicle,
                          const BendLimits& limits) {
  const std::vector<double>& curvature = profile.curvature_per_m;
  profile.most_mps.clear();
  for (std::size_t i = 0; i < curvature.size(); ++i) {
    const std::size_t a = i > 0 ? i - 1 : i, b = std::min(i + 1, curvature.size() - 1);
    const double apart = std::max(1e-6, profile.ahead_m[b] - profile.ahead_m[a]);
    profile.most_mps.push_back(
        bend_speed_mps(curvature[i], (curvature[b] - curvature[a]) / apart, vehicle, limits));
  }
}

std::vector<double> drive_on(const PathProfile& profile, double speed_mps, double until_m,
                             double speeds_up_mps2) {
  constexpr double kStep_s = 0.1;
  constexpr std::size_t kMostSteps = 150;
  std::vector<double> ahead{0.0};
  while (ahead.back() < until_m && ahead.size() < kMostSteps) {
    const double most = std::max(1.0, profile.wanted_mps[profile.before(ahead.back())]);
    speed_mps = std::min(speed_mps + speeds_up_mps2 * kStep_s, most);
    ahead.push_back(ahead.back() + kStep_s * speed_mps);
  }
  return ahead;
}

double on_road_m(const PathProfile& profile, const map::RoadMap& road_map) {
  std::size_t i = 0;
  while (i < profile.body.size() && !is_on_road(profile.body[i], road_map)) ++i;
  while (i < profile.body.size() && is_on_road(profile.body[i], road_map)) ++i;
  return i < profile.body.size() ? profile.ahead_m[i - 1] : std::numeric_limits<double>::infinity();
}

}  // namespace roadbed::planning::speed
