#pragma once

#include <optional>
#include <vector>

#include "roadbed/geometry/primitives/pose2.h"
#include "roadbed/map/opendrive/rules/source.h"

// Lanes of OpenDRIVE that go on where a lane section ends and another one begins, whether of the
// same road or of the next one.

namespace roadbed::map::inline repair {

/// One side of a seam between lane sections.
struct SeamSide {
  const opendrive::rules::RoadSource* road = nullptr;
  const opendrive::LaneSection* section = nullptr;
  opendrive::ContactPoint end = opendrive::ContactPoint::start;
  /// Of the reference line there, in its own direction: x ahead, y to the left. Within a road any
  /// one does, the same for both sides.
  geometry::Pose2 map_from_line = {};
};

/// A lane on either side of a seam.
struct SeamLanes {
  const opendrive::LaneRecord *here, *there;
};

/// Lanes of the same number and type that no link joins to anything over the seam; where two starts
/// or two ends meet, left lanes are right ones on the other side.
std::vector<SeamLanes> free_lanes(const SeamSide& here, const SeamSide& there);

/// Those of them that have a width on both sides and whose corners meet in plan.
std::vector<SeamLanes> meeting_lanes(const SeamSide& here, const SeamSide& there,
                                     double tolerance_m);

/// Where the borders of a lane end, to the left of the reference line.
struct LaneCorners {
  double inner_t_m = 0.0, outer_t_m = 0.0;
};

/// By the lane offset and the widths or borders up to the lane; how the road leans is not looked
/// at. None where one of these lanes is missing, repeated, or has no record there.
/// @param lane  not 0.
std::optional<LaneCorners> lane_corners(const SeamSide& side, int lane);

}  // namespace roadbed::map::repair
