#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "roadbed/geometry/motion/rectangle.h"
#include "roadbed/geometry/motion/trajectory.h"
#include "roadbed/geometry/motion/vehicle_shape.h"
#include "roadbed/map/occupancy/clearance/clearance_field.h"
#include "roadbed/planning/obstacles/obstacle.h"
#include "roadbed/planning/obstacles/prediction.h"

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
  std::size_t with = 0;     ///< what it was; means something to the same checker only
  geometry::Rectangle standing = {};  ///< the body or cell, unless it was something that moves
};

/// Distances of a driving vehicle to obstacles, at every moment of the drive.
class CollisionChecker {
 public:
  CollisionChecker(const CollisionScene& scene, const geometry::VehicleShape& vehicle,
                   const CollisionOptions& options);
  ~CollisionChecker();
  CollisionChecker(CollisionChecker&&) noexcept;
  CollisionChecker& operator=(CollisionChecker&&) noexcept;

  /// Whether the vehicle keeps the clearance all along a drive: from standing obstacles and
  /// occupied cells over its whole length, from moving ones up to the horizon, each at the time
  /// at which the vehicle is there; one that stands from the start on is a standing one. Between
  /// the points position and heading are linear.
  ///
  /// Nothing is missed between points: from a pose with clearance c the drive is followed only as
  /// far as no point of the body can come nearer than the demanded clearance. A drive that is
  /// found free keeps the clearance; one that is not comes nearer than clearance + tolerance.
  bool is_free(const std::vector<geometry::TrajectoryPoint>& drive) const {
    return !first_contact(drive);
  }

  /// What a drive comes too near to, and where; none if it is free.
  std::optional<Contact> first_contact(const std::vector<geometry::TrajectoryPoint>& drive) const;

  /// The same of some things().
  std::optional<Contact> first_contact(const std::vector<geometry::TrajectoryPoint>& drive,
                                       std::span<const std::size_t> things) const;

  /// Distance of the vehicle's body at a time to what another drive came too near to; infinite
  /// where that is not looked at any more.
  double distance_m(const Contact& other, const geometry::Rectangle& body, double t_s) const;

  /// Whether a drive that has the body there at that time cannot be free, because of what another
  /// drive came too near to: a quick first look at drives that are much alike.
  /// @param driven_m  on the drive before; may be off by a centimetre.
  bool surely_hits(const Contact& other, const geometry::Rectangle& body, double t_s,
                   double driven_m) const;

  /// Whether there is nothing to come too near to.
  bool is_empty() const;

  /// What there is to come too near to: as Contact::with.
  std::vector<std::size_t> things() const;

  /// Whether a body that is within a cover from one time to another surely is free of one of them.
  /// `false` says nothing.
  bool keeps_clear(std::size_t with, const geometry::Rectangle& cover, double from_t_s,
                   double to_t_s) const;

  /// Another clearance from now on.
  void set_clearance(double clearance_m);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace roadbed::planning::lateral
