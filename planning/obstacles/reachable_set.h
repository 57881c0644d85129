#pragma once

#include <Eigen/Core>
#include <limits>
#include <vector>

#include "roadbed/geometry/motion/longitudinal.h"
#include "roadbed/geometry/motion/rectangle.h"
#include "roadbed/map/model/road_map.h"
#include "roadbed/planning/obstacles/obstacle.h"

namespace roadbed::planning::inline obstacles {

/// How somebody moves at most. By default whatever tyres and feet can do; `by_the_rules()` is what
/// may be expected of those who keep to them.
struct MotionBounds {
  double max_acceleration_mps2 = geometry::kLongitudinal.max_braking_mps2;  ///< in any direction
  double max_gain_mps2 = 8.0;  ///< of speed, along its way
  /// Of the speed limit, up to 60 m/s; who is faster gets no faster.
  double max_speeding = std::numeric_limits<double>::infinity();
  double max_sideways_mps = 5.0;  ///< beside the middle of its way, on the road
  double max_off_road_mps = 1.0;  ///< the same off the road
  double max_turned_sine = 0.35;  ///< of the body against its way
  double max_walking_mps = 4.0;
  /// It stays in its lane, unless it is changing lanes already; who is parked stays, and who walks
  /// keeps his velocity but for `max_off_road_mps`.
  bool keeps_lane = false;
  double position_error_m = 0.0, speed_error_mps = 0.0;  ///< of what is known of it
};
MotionBounds by_the_rules();

/// Where a body may be that was seen at one time: a set for each later time that holds it whatever
/// it does within its bounds, as rectangles along the ways on that its lanes leave it [Althoff and
/// Magdici 2016, "Set-Based Prediction of Traffic Participants on Arbitrary Road Networks",
/// doi:10.1109/TIV.2016.2622920].
///
///                        ╭────╮ ╭──╮    no less far than braking leads, no farther than speeding
///                        up;
///     ┌─────┐      ┌─────┤    ├─╯  │    as far beside as it gets in that time, off the road more
///     │  ×──┼▶     │     │    │ ╭──╯    slowly; within the reach of its acceleration in any
///     └─────┘      └─────┤    ├─╯       direction
///       now              ╰────╯ later
///
/// Who is on no lane along his heading may go anywhere within that reach. Immutable.
class ReachableSet {
 public:
  /// @param seen_s     when `body` is where it is known to be.
  /// @param horizon_s  sets are asked for up to so long after.
  ReachableSet(const map::RoadMap& road_map, const Obstacle& body, double seen_s, double horizon_s,
               const MotionBounds& bounds);

  /// At any time between two, in seconds after it was seen, the whole body is within these.
  std::vector<geometry::Rectangle> between(double from_s, double to_s) const;

  /// Whether one of them touches a rectangle.
  bool may_touch(const geometry::Rectangle& other, double from_s, double to_s) const;

 private:
  struct Slice {
    geometry::Pose2 middle;  ///< of the way
    double bend_per_m;       ///< without sign
    double right_m, left_m;  ///< of the road or lane that its centre keeps to
  };
  struct Way {
    std::vector<Slice> slices;  ///< from `first_s_m` on, where the body's centre is at 0
    double first_s_m;
    double d_m, sideways_mps;  ///< of the body's centre
    double along_mps, most_mps;
    double bend_per_m;  ///< the greatest
    double turned_sine;
  };

  void add_way(const map::RoadMap& road_map, const struct LanesAhead& lanes,
               const map::LaneMatch& at, double horizon_s);
  void widen_rooms(Way& way) const;
  template <typename Visit>
  bool any_of(double from_s, double to_s, const Visit& visit) const;
  template <typename Visit>
  bool any_of_way(const Way& way, double from_s, double to_s, const Visit& visit) const;
  geometry::Rectangle anywhere(double from_s, double to_s) const;
  double reach_m(double after_s) const;
  bool is_out_of_reach(const geometry::Rectangle& place, double from_s, double to_s) const;

  MotionBounds bounds_;
  geometry::Rectangle body_;
  Eigen::Vector2d velocity_;
  bool walks_, stays_;
  std::vector<Way> ways_;
};

}  // namespace roadbed::planning::obstacles
