#pragma once

#include <limits>
#include <string>

#include "roadbed/geometry/motion/rectangle.h"
#include "roadbed/geometry/motion/trajectory.h"
#include "roadbed/geometry/primitives/pose2.h"
#include "roadbed/map/model/road_map.h"

namespace roadbed::planning::inline obstacles {

/// Seconds of a drive.
struct TimeSpan {
  double from_s = 0.0, to_s = 0.0;

  bool holds(double t_s) const { return t_s >= from_s && t_s <= to_s; }  ///< with both ends
};

inline constexpr TimeSpan kAlways{-std::numeric_limits<double>::infinity(),
                                  std::numeric_limits<double>::infinity()};
inline constexpr TimeSpan kNever{kAlways.to_s, kAlways.from_s};

/// What positions are told in: the map's own frame, or the coordinates of the files.
enum class Frame { map, source };

/// A rectangle that stands or moves, for as long as it is there.
///
///     ┌──────────────┐ ─┬─
///     │      ×───────┼▶ │ width_m     × pose of `motion`: the centre, not an axle
///     └──────────────┘ ─┴─
///     ├── length_m ──┤
///
/// @tparam kFrame  of `motion`: an obstacle of one frame is no obstacle of the other.
/// @tparam Motion  a trajectory, or a `Prediction`.
template <Frame kFrame, typename Motion = geometry::Trajectory>
struct ObstacleIn {
  std::string id;
  std::string kind = "car";  ///< "car", "truck", "pedestrian", "static", …
  double length_m = 4.5;
  double width_m = 1.8;
  Motion motion;                ///< where it is, or will be; one point: it stands
  TimeSpan validity = kAlways;  ///< when it is there
  TimeSpan away = kNever;       ///< within that, when it is over or under the road

  bool is_static() const { return motion.points().size() == 1; }
  bool is_there(double t_s) const {  ///< at a time
    return validity.holds(t_s) && !away.holds(t_s);
  }
  /// Pose of the centre at a time, there or not.
  geometry::Pose2 pose_at(double t_s) const {
    if constexpr (requires { motion.at(t_s).pose(); }) {
      return motion.at(t_s).pose();
    } else {
      return motion.at(t_s);
    }
  }
};

using Obstacle = ObstacleIn<Frame::map>;
using ObstacleInSource = ObstacleIn<Frame::source>;

/// A rectangle around a centre.
geometry::Rectangle body_around(const geometry::Pose2& centre, double length_m, double width_m);

/// The rectangle of an obstacle where its motion has it at a time, there or not.
template <Frame kFrame, typename Motion>
geometry::Rectangle rectangle_at(const ObstacleIn<kFrame, Motion>& obstacle, double t_s) {
  return body_around(obstacle.pose_at(t_s), obstacle.length_m, obstacle.width_m);
}

/// The same obstacle in the other frame.
ObstacleInSource obstacle_in_source(const map::RoadMap& road_map, const Obstacle& obstacle);
Obstacle obstacle_in_map(const map::RoadMap& road_map, const ObstacleInSource& obstacle);

}  // namespace roadbed::planning::obstacles
