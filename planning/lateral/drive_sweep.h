#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "roadbed/geometry/motion/trajectory.h"
#include "roadbed/planning/lateral/collision_things.h"

namespace roadbed::planning::inline lateral {

/// One section of a drive, between two of its points.
struct DriveSegment {
  double length_m;  ///< straight
  double motion_m;  ///< no point of the body moves farther
  double duration_s;
  double from_m;  ///< length of the drive before it
};

/// One per pair of points. @param reach_m  of the vehicle.
std::vector<DriveSegment> segments_of(const std::vector<geometry::TrajectoryPoint>& drive,
                                      double reach_m);

/// Parts of a segment, at whose ends a drive is never found free that is nearer to a mover than
/// clearance + tolerance; to what stands, at its own ends.
inline constexpr int kSweepParts = 8;

/// Where a drive first comes too near to one thing; none if it does not. The thing is looked at
/// from those points of the drive that may be near to it, and between two of them from the middle,
/// the middles of both halves, and so on, until the rest surely is clear.
///
///     ●───────────────●───────┼───┼───●─┼─┼─┼─┼─●───────────────●
///      clear by the distance        halved            clear
///
/// From a pose with slack c (distance less what is demanded) no point of the body, or of the thing,
/// comes nearer than c less what both move; so between two poses, ½ (c + c′ − motion) is left. Of
/// what moves almost as the body does, beside it, that says little: there, what parts both along
/// one direction at both poses parts them in between, but for the bend of their paths.
std::optional<Contact> first_contact(const CollisionThings& things, std::size_t with,
                                     const std::vector<geometry::TrajectoryPoint>& drive,
                                     const std::vector<DriveSegment>& segments);

}  // namespace roadbed::planning::lateral
