#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "roadbed/geometry/motion/rectangle.h"
#include "roadbed/geometry/motion/trajectory.h"
#include "roadbed/geometry/motion/vehicle_shape.h"
#include "roadbed/planning/lateral/collision_things.h"

namespace roadbed::planning::inline lateral {

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

  /// Parts of a drive's segments, at whose ends one that is found free surely keeps clearance +
  /// tolerance from what another drive came too near to.
  static int parts(const Contact& other);

  /// Whether a drive that has the body there at that time, at such an end, cannot be free, because
  /// of what another drive came too near to: a quick first look at drives that are much alike.
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
  std::unique_ptr<CollisionThings> things_;
};

}  // namespace roadbed::planning::lateral
