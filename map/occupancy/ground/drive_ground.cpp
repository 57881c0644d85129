#include "roadbed/map/occupancy/ground/drive_ground.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>
#include <vector>

#include "roadbed/map/occupancy/ground/drive_places.h"

namespace roadbed::map::inline occupancy::inline ground {
namespace {

using Eigen::Vector2d;
using map::GroundPlace;

constexpr double kSameRoad_m = 0.5;  // heights that differ by less belong to one surface

/// The plane that touches a lane's surface at a place of it.
GroundPlace plane_of(const map::Lane& lane, const map::LaneMatch& match, const Vector2d& point) {
  constexpr double step_m = 0.5;
  const double s_m = match.place.s_m, length_m = lane.length_m();
  const double from_m = std::max(0.0, s_m - step_m), to_m = std::min(length_m, s_m + step_m);
  const Vector2d ahead(std::cos(match.heading_rad), std::sin(match.heading_rad));
  GroundPlace plane{.in_source = point, .z_m = map::Lane::height_at(lane.centre, s_m)};
  if (to_m > from_m) {
    const double rise_m =
        map::Lane::height_at(lane.centre, to_m) - map::Lane::height_at(lane.centre, from_m);
    plane.slope += rise_m / (to_m - from_m) * ahead;
  }
  const Vector2d across =
      map::Lane::point_at(lane.left, s_m) - map::Lane::point_at(lane.right, s_m);
  constexpr double least_width_m = 0.1;
  if (across.norm() > least_width_m) {
    const double rise_m =
        map::Lane::height_at(lane.left, s_m) - map::Lane::height_at(lane.right, s_m);
    const double fall = rise_m / across.norm();
    plane.slope += fall * Vector2d(-ahead.y(), ahead.x());
    plane.z_m += fall * match.place.d_m;
  }
  return plane;
}

/// Follows the surface of one road.
class RoadFollower {
 public:
  explicit RoadFollower(const map::RoadMap& road_map) : road_map_(road_map) {}

  GroundPlace at(const geometry::Pose2& pose) {
    std::vector<Candidate> candidates = near(pose);
    const Vector2d point = pose.position();
    const auto worse = [&](const Candidate& a, const Candidate& b) {
      return std::pair(beside(a, point), a.off_m) < std::pair(beside(b, point), b.off_m);
    };
    if (!last_) check_is_one(candidates, pose);
    const Candidate best = *std::ranges::min_element(candidates, worse);
    if (last_ && beside(best, point) > kSameRoad_m) {
      refuse_ground(
          point,
          fmt::format("the lanes lie {:.2f} m above or below the road so far", beside(best, point)),
          "a road without a step");
    }
    last_ = best.plane;
    return best.plane;
  }

 private:
  struct Candidate {
    GroundPlace plane;
    double off_m, turned_rad;
  };

  double beside(const Candidate& candidate, const Vector2d& point) const {
    return last_ ? std::abs(candidate.plane.z_m - plane_at(*last_, point)) : 0.0;
  }

  std::vector<Candidate> near(const geometry::Pose2& pose) const {
    constexpr double radius_m = 20.0, same_m = 0.5;
    const Vector2d point = pose.position();
    std::vector<Candidate> candidates;
    for (const map::LaneMatch& match : road_map_.locate(road_map_.to_map(point), radius_m, false)) {
      if (!candidates.empty() && match.distance_m > candidates.front().off_m + same_m) break;
      const double turned_rad = std::remainder(match.heading_rad - pose.heading_rad, M_PI);
      candidates.push_back({plane_of(road_map_.lane(match.place.lane), match, point),
                            match.distance_m, std::abs(turned_rad)});
    }
    if (candidates.empty()) {
      refuse_ground(point, fmt::format("is over {} m from every lane", radius_m), "a lane");
    }
    return candidates;
  }

  // Of roads above one another, those along the drive count.
  static void check_is_one(std::vector<Candidate>& candidates, const geometry::Pose2& pose) {
    const auto spread_m = [&] {
      const auto [low, high] = std::ranges::minmax_element(
          candidates, {}, [](const Candidate& candidate) { return candidate.plane.z_m; });
      return high->plane.z_m - low->plane.z_m;
    };
    if (spread_m() <= kSameRoad_m) return;
    constexpr double along_rad = 0.8;
    const auto is_across = [](const Candidate& candidate) {
      return candidate.turned_rad > along_rad;
    };
    if (!std::ranges::all_of(candidates, is_across)) std::erase_if(candidates, is_across);
    if (spread_m() <= kSameRoad_m) return;
    refuse_ground(pose.position(), fmt::format("roads lie {:.1f} m above one another", spread_m()),
                  "a start that is on one road only");
  }

  const map::RoadMap& road_map_;
  std::optional<GroundPlace> last_;
};

}  // namespace

map::Ground road_under(const map::RoadMap& road_map, const geometry::Trajectory& drive_in_source) {
  RoadFollower follower(road_map);
  std::vector<GroundPlace> places;
  for (const geometry::Pose2& pose : places_along(drive_in_source)) {
    places.push_back(follower.at(pose));
  }
  check_is_single(places);
  return map::Ground(std::move(places));
}

}  // namespace roadbed::map::occupancy::ground
