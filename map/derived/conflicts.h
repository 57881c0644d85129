#pragma once

#include <vector>

#include "roadbed/map/model/road_map.h"

namespace roadbed::map::inline derived {

/// How two lanes that overlap came to do so.
enum class ConflictKind {
  crossing,   ///< they share neither end
  merging,    ///< they share a successor
  diverging,  ///< they share a predecessor
};

/// Two lanes that overlap though neither follows the other and they are not beside each other:
/// who is on one of them may be hit from the other.
///
///             other
///               ║ ║
///        ═══════╬═╬═══════ one         on_one: the stations between which any part of `one`
///        ═══════╬═╬═══════             is also in `other`; on_other likewise
///               ║ ║
struct Conflict {
  LaneId one, other;  ///< one < other
  ConflictKind kind = ConflictKind::crossing;
  StationRange on_one, on_other;
  double area_m2 = 0.0;  ///< of the overlap

  /// @pre `lane` is one of the two
  LaneId partner_of(LaneId lane) const { return lane == one ? other : one; }
  const StationRange& on(LaneId lane) const { return lane == one ? on_one : on_other; }
};

struct ConflictOptions {
  /// Overlaps of a lesser mean width (area by the diagonal of their box) are lanes that touch, as
  /// sampled borders and roads that do not meet exactly make them do.
  double least_width_m = 0.05;
  double headroom_m = 2.5;  ///< lanes further apart in height pass over each other
};

/// Every conflict between drivable lanes, by lane `one`, then `other`, then place. Lanes that meet
/// twice, as at the ends of a loop, are in conflict twice. A lane is taken as the strip that its
/// cross-sections sweep, from border to border at equal stations; the overlap of two strips is
/// clipped piece by piece, so its stations are exact up to rounding.
/// O((N + K) log N) for N vertices and K pairs of pieces that meet.
/// @throws InputError where far too many lanes lie over each other.
std::vector<Conflict> find_conflicts(const RoadMap& road_map, const ConflictOptions& options = {});

/// Those of one lane, on either side: looks at the lanes near it only. Areas may differ from those
/// above in their last digits. Lanes without a polygon have none.
std::vector<Conflict> find_conflicts_of(const RoadMap& road_map, LaneId lane,
                                        const ConflictOptions& options = {});

/// How many roads are stacked below a lane where most are: 0 on the ground, 1 on a bridge over
/// another road. All lanes of a road are on one level, so that a picture can be drawn level by
/// level. One number per lane; two lanes are stacked where they overlap further apart in height
/// than `headroom_m`. O((N + K) log N) for N vertices and K pairs of pieces that meet.
std::vector<int> levels_of_lanes(const RoadMap& road_map, double headroom_m = 2.5);

}  // namespace roadbed::map::derived
