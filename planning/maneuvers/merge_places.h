#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "roadbed/geometry/primitives/polyline.h"
#include "roadbed/map/model/road_map.h"
#include "roadbed/planning/reference/reference_line.h"
#include "roadbed/planning/route/route.h"

namespace roadbed::planning::inline maneuvers {

/// Where a route changes to the next lane of its direction.
struct MergePlace {
  std::size_t leg = 0;      ///< of the route, that the change leaves
  double from_s_m = 0.0;    ///< of the line: from here on the change may be made
  double hold_s_m = 0.0;    ///< of the line: here the front waits without being in anybody's way
  double enter_s_m = 0.0;   ///< of the line: beyond it the front is in the way of the next lane
  double out_s_m = 0.0;     ///< of the line: the vehicle drives in the next lane
  geometry::Polyline lane;  ///< middle of the next lane, from where it can be looked at
  double enter_m = 0.0;     ///< station of that, beside enter_s_m
};

/// All changes of a route, by station. The next lane is followed back over its straightest
/// predecessors for 250 m. O(legs · points of the lanes).
std::vector<MergePlace> merge_places(const map::RoadMap& road_map, const Route& route,
                                     const ReferenceLine& line);

/// The same route with a change at both ends of what the map leaves for it: the marking may be
/// crossed and both lanes run beside each other.
///
///     ───────────────────────────────────────────────
///        ╭─ next_lane ───────────────────────────────
///     ─ ╱ ─ ─ ─ ─ ─ ─ ─ ─ ─ ─ ─ ─ ─ ─ ─ ─ ╱─ ─ ─ ─ ─
///     ─╯────────────────────── own_lane ─╯
///     ───first──────────────────────hold──────last
///
/// Stations are those of MergePlace::lane.
struct MergeLines {
  ReferenceLine next_lane;  ///< changes as early as it may
  ReferenceLine own_lane;   ///< as late as it may, over 30 m
  double first_m = 0.0;     ///< before it nobody is to be in the way of the next lane
  double hold_m = 0.0;      ///< here the front waits at the latest
  double last_m = 0.0;      ///< a change has to have ended
  double out_s_m = 0.0;     ///< of own_lane: from here on all lines are the same
};

/// None: the lanes are beside each other for too short a way to choose from.
std::optional<MergeLines> merge_lines(const map::RoadMap& road_map, const Route& route,
                                      const MergePlace& place, ReferenceLineOptions options);

}  // namespace roadbed::planning::maneuvers
