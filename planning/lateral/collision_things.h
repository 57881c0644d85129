#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <functional>
#include <limits>
#include <optional>
#include <span>
#include <vector>

#include "roadbed/geometry/motion/rectangle.h"
#include "roadbed/geometry/motion/trajectory.h"
#include "roadbed/geometry/motion/vehicle_shape.h"
#include "roadbed/map/occupancy/clearance/clearance_field.h"
#include "roadbed/planning/obstacles/obstacle.h"
#include "roadbed/planning/obstacles/prediction.h"
#include "roadbed/planning/obstacles/static_obstacles.h"

namespace roadbed::planning::inline lateral {

struct CollisionOptions {
  int circles = 3;           ///< that cover the vehicle, for the first look
  double clearance_m = 0.3;  ///< to keep from everything
  /// Where a drive begins cannot be chosen any more: what it begins nearer to than the clearance
  /// has to be kept as far from as there, and the whole clearance after this way. Linear between.
  double recovery_m = 10.0;
  double tolerance_m = 0.02;  ///< see CollisionChecker::is_free
  double horizon_s = 5.0;     ///< moving obstacles are checked this far ahead
};

/// What stands and moves around, ready to be asked for many drives. Lengths in the map's frame.
struct CollisionScene {
  const std::vector<Obstacle>& obstacles;
  const map::ClearanceField* field = nullptr;  ///< none: no occupancy
  Eigen::Vector2d origin_in_source{0, 0};      ///< source = map + origin, for the field
  double start_t_s = 0.0;
  std::span<const PredictedObstacle> predicted = {};  ///< besides `obstacles`
  /// If given, only what moves counts, and of that what this holds for: of its centre at the start.
  std::function<bool(const geometry::Pose2&)> counts = {};
};

/// Where a drive comes too near to something.
struct Contact {
  std::size_t segment = 0;  ///< of the drive: between its points `segment` and `segment` + 1
  double fraction = 0.0;    ///< of that segment, from its first point on
  std::size_t with = 0;     ///< what it was; means something to the same checker only
  geometry::Rectangle standing = {};  ///< the body or cell, unless it was something that moves
};

/// The vehicle at one moment of a drive.
struct DriveMoment {
  DriveMoment(double at_s, const geometry::Pose2& at, const geometry::VehicleShape& vehicle)
      : t_s(at_s), pose(at), body(geometry::body_at(at, vehicle)) {}

  Eigen::Vector2d on_axis(double x_m) const { return pose.position() + x_m * body.axis; }

  double t_s;
  geometry::Pose2 pose;
  geometry::Rectangle body;
};

/// Something that moves.
struct Mover {
  std::function<geometry::Pose2(double t_s)> centre_at;
  /// Between two times no point of its body is farther from the straight line between its places.
  std::function<double(double from_s, double to_s)> bend_m;
  double length_m, width_m;
  double rate_mps;  ///< no point of its body moves faster until then
  double until_s;   ///< of the scene; it is not looked at later

  geometry::Rectangle body_at(double t_s) const;
};

/// What a drive may come too near to, each by its number: as Contact::with. Distances to it, and
/// which are demanded of drives that begin at one place.
class CollisionThings {
 public:
  static constexpr std::size_t kStanding = 0, kOccupied = 1, kFirstMover = 2;

  CollisionThings(const CollisionScene& scene, const geometry::VehicleShape& vehicle,
                  const CollisionOptions& options);

  const geometry::VehicleShape& vehicle() const { return vehicle_; }
  const CollisionOptions& options() const { return options_; }
  void set_clearance(double clearance_m);

  /// Their numbers.
  std::vector<std::size_t> numbers() const;
  const Mover& mover(std::size_t with) const { return movers_[with - kFirstMover]; }

  /// Where the drives begin that are asked about from now on.
  void begin_at(const geometry::TrajectoryPoint& start);
  double demanded_m(std::size_t with, double driven_m) const;
  double demand_slope(std::size_t with) const {  ///< per metre driven
    return (options_.clearance_m - at_start_m_[with]) / options_.recovery_m;
  }
  /// What is farther away than demanded by this is free.
  double enough_beyond_m(double demanded_m) const;

  /// The distance at a moment, or any lower bound of it above `enough_m`.
  double distance_m(std::size_t with, const DriveMoment& moment, double enough_m) const;
  /// The same to a mover that is there then.
  double distance_m(const geometry::Rectangle& mover, const DriveMoment& moment,
                    double enough_m) const;
  /// The standing body or the occupied cell that is nearest at a moment of contact; of a mover
  /// none.
  geometry::Rectangle nearest(std::size_t with, const DriveMoment& moment) const;

  /// Whether a cover keeps a distance from what stands.
  bool is_clear(std::size_t with, const geometry::Rectangle& cover, double distance_m) const;
  /// Whether it surely is farther than that for some time from anything; `false` says nothing.
  bool is_far(std::size_t with, const geometry::Rectangle& cover, double from_t_s, double to_t_s,
              double distance_m) const;

 private:
  bool is_counted(const geometry::Pose2& centre) const {
    return !scene_.counts || scene_.counts(centre);
  }
  double horizon_end_s() const { return scene_.start_t_s + options_.horizon_s; }
  void add(const Obstacle& obstacle);
  void add(const PredictedObstacle& obstacle);
  bool is_far_from_occupied(const geometry::Rectangle& cover, double distance_m) const;
  geometry::Rectangle nearest_cell(const DriveMoment& moment) const;
  geometry::Pose2 in_source(const geometry::Pose2& in_map) const;
  double from_standing_m(const DriveMoment& moment, double enough_m) const;
  double from_occupied_m(const DriveMoment& moment, double enough_m) const;

  CollisionScene scene_;
  geometry::VehicleShape vehicle_;
  CollisionOptions options_;
  geometry::CoveringCircles circles_;
  StaticObstacles standing_;
  std::vector<Mover> movers_;

  // Of the drives that begin there: what is demanded at first, by what it is kept from.
  std::optional<geometry::TrajectoryPoint> start_;
  std::vector<double> at_start_m_;
};

}  // namespace roadbed::planning::lateral
