#pragma once

#include <Eigen/Core>
#include <span>
#include <string>
#include <vector>

#include "roadbed/geometry/motion/rectangle.h"
#include "roadbed/planning/obstacles/obstacle.h"

namespace roadbed::planning::inline tracking {

/// How boxes without names are followed from one time to the next.
struct FollowerOptions {
  double fastest_mps = 40.0;       ///< of what has been seen once
  double speed_change_mps = 10.0;  ///< of what has been seen more often, from one time to the next
  double shift_m = 1.0;            ///< by which the middle moves as more of the body is seen
  double coasts_for_s = 0.5;       ///< so long an object may be unseen
  double moves_m = 0.3;            ///< whose ends both go less far stands
};

/// One object, as it was seen.
struct FollowedObject {
  /// At one time.
  struct Sight {
    double t_s;
    geometry::Rectangle box;  ///< of unknown front: its axis may be any of its four
  };
  std::vector<Sight> sights;               ///< times increase
  Eigen::Vector2d velocity_mps{0.0, 0.0};  ///< of the last sight
};

/// Follows what was seen as boxes in the plane: each box is given to the object that it fits best
/// in all (assignment.h), by the distance of its middle from where the object would be at its last
/// velocity, and by how much its sides differ; or it is a new object. Tracker is for detections
/// that know their speeds and fronts.
class ObjectFollower {
 public:
  /// Without any object so far.
  explicit ObjectFollower(const FollowerOptions& options = {}) : options_(options) {}

  /// Takes all that was seen at a time.
  /// @throws std::invalid_argument if the time is not later than that of the call before.
  void observe(double t_s, std::span<const geometry::Rectangle> boxes);

  /// In the order in which they were first seen.
  const std::vector<FollowedObject>& objects() const { return objects_; }

  /// The objects as obstacles "object 1", … around all that was seen of them. Who stands is there
  /// for ever. Who moves has its front where it moves to, and is there from when it was first seen
  /// to the next time at which it was not, going on until then; so is, standing, what was seen only
  /// once, unless there was one time only.
  std::vector<ObstacleInSource> obstacles() const;

 private:
  double cost(const FollowedObject& object, const geometry::Rectangle& box, double t_s) const;
  double gone_s(const FollowedObject& object) const;
  bool moves(const FollowedObject& object) const;

  FollowerOptions options_;
  std::vector<double> times_s_;
  std::vector<FollowedObject> objects_;
};

}  // namespace roadbed::planning::tracking
