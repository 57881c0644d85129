#include "roadbed/planning/obstacles/other_levels.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "roadbed/geometry/primitives/angle.h"

namespace roadbed::planning::inline obstacles {
namespace {

constexpr double kPlacesApart_m = 4.0, kAhead_m = 200.0, kBehind_m = 50.0;
constexpr double kLevelsAround_m = 15.0;  // half a long lorry, and a lane beside the route
constexpr double kAlongLane_rad = 0.6;

/// Whether no heights of the map differ by so much.
bool is_flat(const map::RoadMap& road_map, double headroom_m) {
  double least_m = 1e300, most_m = -1e300;
  for (const map::Lane& lane : road_map.lanes()) {
    for (const double z_m : lane.centre.z_m) {
      least_m = std::min(least_m, z_m);
      most_m = std::max(most_m, z_m);
    }
  }
  return most_m - least_m <= headroom_m;
}

bool is_along(double lane_rad, double heading_rad) {
  return std::abs(geometry::wrap_angle(heading_rad - lane_rad)) < kAlongLane_rad;
}

bool is_along_any(const std::vector<double>& lanes_rad, double heading_rad) {
  return std::ranges::any_of(lanes_rad,
                             [&](double lane_rad) { return is_along(lane_rad, heading_rad); });
}

double apart_m2(const geometry::Pose2& a, const geometry::Pose2& b) {
  return (a.position() - b.position()).squaredNorm();
}

}  // namespace

OtherLevels::OtherLevels(const map::RoadMap& road_map, const Route& route, double headroom_m) {
  if (is_flat(road_map, headroom_m)) return;
  for (const RouteLeg& leg : route.legs) {
    const map::Lane& lane = road_map.lane(leg.lane);
    const double along = leg.to_s_m < leg.from_s_m ? -1.0 : 1.0;
    const double length_m = std::abs(leg.to_s_m - leg.from_s_m);
    for (double driven_m = 0.0; driven_m < length_m + kPlacesApart_m; driven_m += kPlacesApart_m) {
      const double s_m = leg.from_s_m + along * std::min(driven_m, length_m);
      const double z_m = map::Lane::height_at(lane.centre, s_m);
      const geometry::Pose2 turned{0.0, 0.0, leg.reversed ? std::numbers::pi : 0.0};
      Place place{
          .on_route = lane.pose_at(s_m) * turned, .same_level_rad = {}, .other_level_rad = {}};
      for (const map::LaneMatch& match :
           road_map.locate(place.on_route.position(), kLevelsAround_m, true)) {
        const map::Lane& near = road_map.lane(match.place.lane);
        const double above_m = map::Lane::height_at(near.centre, match.place.s_m) - z_m;
        (std::abs(above_m) > headroom_m ? place.other_level_rad : place.same_level_rad)
            .push_back(match.heading_rad);
      }
      places_.push_back(std::move(place));
    }
  }
  const auto has_levels = [](const Place& place) { return !place.other_level_rad.empty(); };
  if (std::ranges::none_of(places_, has_levels)) places_.clear();
}

/// Of the stretch that the vehicle is on: a route may lead over a place and later under it.
OtherLevels::Places OtherLevels::near_other_levels(const geometry::Pose2& map_from_vehicle) const {
  const auto off_m2 = [&](const Place& place) {
    const bool is_own = is_along(place.on_route.heading_rad, map_from_vehicle.heading_rad);
    return is_own ? apart_m2(place.on_route, map_from_vehicle) : 1e300;
  };
  const auto here = std::ranges::min_element(places_, {}, off_m2) - places_.begin();
  const auto behind = static_cast<std::ptrdiff_t>(kBehind_m / kPlacesApart_m);
  const auto ahead = static_cast<std::ptrdiff_t>(kAhead_m / kPlacesApart_m);
  const auto end = std::min(std::ssize(places_), here + ahead);
  Places near;
  for (auto i = std::max<std::ptrdiff_t>(0, here - behind); i < end; ++i) {
    const Place& place = places_[static_cast<std::size_t>(i)];
    if (!place.other_level_rad.empty()) near.push_back(&place);
  }
  return near;
}

/// Whether a vehicle is over or under the route there.
bool OtherLevels::hold(const Places& places, const geometry::Pose2& centre) {
  const auto off_m2 = [&](const Place* place) { return apart_m2(place->on_route, centre); };
  const auto nearest = std::ranges::min_element(places, {}, off_m2);
  return nearest != places.end() && off_m2(*nearest) < kLevelsAround_m * kLevelsAround_m &&
         is_along_any((*nearest)->other_level_rad, centre.heading_rad) &&
         !is_along_any((*nearest)->same_level_rad, centre.heading_rad);
}

/// From now on. From one point of its motion to the next it is away if it is so at either.
TimeSpan OtherLevels::time_away(const Places& places, double t_s, const Obstacle& obstacle) {
  const std::vector<geometry::TrajectoryPoint>& points = obstacle.motion.points();
  if (obstacle.is_static()) return hold(places, points.front().pose()) ? kAlways : kNever;
  TimeSpan away = kNever;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const double next_s = i + 1 < points.size() ? points[i + 1].t_s : kAlways.to_s;
    if (next_s < t_s) continue;
    if (hold(places, points[i].pose())) {
      away.from_s = std::min(away.from_s, i == 0 ? kAlways.from_s : points[i - 1].t_s);
      away.to_s = next_s;
    } else if (away.to_s > away.from_s) {
      break;
    }
  }
  return away;
}

void OtherLevels::leave_out(const geometry::Pose2& map_from_vehicle, double t_s,
                            std::vector<Obstacle>& obstacles) const {
  if (places_.empty()) return;
  const Places places = near_other_levels(map_from_vehicle);
  for (Obstacle& obstacle : obstacles) {
    const bool drives = obstacle.kind != "pedestrian";
    obstacle.away = drives && !places.empty() ? time_away(places, t_s, obstacle) : kNever;
  }
}

}  // namespace roadbed::planning::obstacles
