#pragma once

#include <functional>

#include "roadbed/geometry/motion/trajectory.h"
#include "roadbed/geometry/primitives/pose2.h"
#include "roadbed/planning/obstacles/obstacle.h"
#include "roadbed/planning/reference/reference_line.h"

namespace roadbed::planning::inline obstacles {

/// What is known of a moving thing at one time; the pose is that of its centre, in the map.
struct ObservedMotion {
  double t_s = 0.0;
  geometry::Pose2 pose;
  double speed_mps = 0.0;        ///< along its heading; negative if it backs up
  double turn_rate_radps = 0.0;  ///< positive to the left
};

/// Where the centre of an obstacle is expected at any time, with a bound of how fast it gets there.
/// Immutable and cheap to copy.
class Prediction {
 public:
  /// As recorded, or planned by itself; before its first and after its last point it stands.
  /// @throws std::invalid_argument if `motion` is empty.
  static Prediction recorded(geometry::Trajectory motion);

  /// Straight on at constant speed, before the observation too.
  /// @throws std::invalid_argument if a number is not finite, here and below.
  static Prediction constant_velocity(const ObservedMotion& seen);

  /// On a circle, at constant speed and turn rate.
  static Prediction constant_turn(const ObservedMotion& seen);

  /// Along a line, such as its lane's, at constant speed and at the offset that it has now; its
  /// heading is the line's, or the opposite one if it drives against it now. Station and speed are
  /// the line's: beside a bend the body moves by 1 − κ d of it. Known every 0.1 s, linear between,
  /// over `duration_s`; then it stands.
  /// @param at_in_line  its present place beside the line.
  static Prediction along_line(const LineView& line, const geometry::LinePosition& at_in_line,
                               const ObservedMotion& seen, double duration_s);

  geometry::Pose2 at(double t_s) const { return at_(t_s); }

  /// Between these times no point within `radius_m` of the centre moves faster [m/s].
  double fastest_mps(double radius_m, double from_s, double to_s) const {
    return fastest_mps_(radius_m, from_s, to_s);
  }

 private:
  using At = std::function<geometry::Pose2(double t_s)>;
  using Fastest = std::function<double(double radius_m, double from_s, double to_s)>;
  Prediction(At at, Fastest fastest_mps)
      : at_(std::move(at)), fastest_mps_(std::move(fastest_mps)) {}

  At at_;
  Fastest fastest_mps_;
};

/// A rectangle that moves as predicted.
using PredictedObstacle = ObstacleIn<Frame::map, Prediction>;

/// Greatest speed of a point within `radius_m` of a trajectory's pose between two times [m/s].
double fastest_mps(const geometry::Trajectory& motion, double radius_m, double from_s, double to_s);

/// How far, between two times, a point within `radius_m` of a trajectory's pose may be from where
/// it would be on a straight line between its places at these times, at a constant speed [m].
double bend_m(const geometry::Trajectory& motion, double radius_m, double from_s, double to_s);

}  // namespace roadbed::planning::obstacles
