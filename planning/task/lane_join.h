#pragma once

#include <optional>
#include <string>

#include "roadbed/map/model/road_map.h"

namespace roadbed::planning::inline task {

/// Where two lanes become one without a lane change, and the one that is asked about gives way.
///
///     ════════════ other ════════════╗
///                                    ╠════════
///     ──── lane ──── from_s_m ╌╌╌╌╌╌╌╝
struct LaneJoin {
  map::LaneId other;
  double from_s_m = 0.0;  ///< of the lane: from here on some of it is in the other, too
};

/// The first join of a lane at which it has to give way; none: it has the right of way, or joins
/// nobody. Who gives way, the first that says so:
/// - a regulation "right_of_way" with both lanes (a junction's priority, in OpenDRIVE);
/// - a sign "stop" or "give way" on the other lane or before it;
/// - the lane that comes from fewer lanes of one direction: a ramp;
/// - the lane that turns more, by 3 degrees;
/// - the lane on the left: right before left (Vienna Convention on Road Traffic, article 18).
/// Lanes that begin more than 46 degrees apart cross, and are no matter of this.
std::optional<LaneJoin> join_to_give_way_at(const map::RoadMap& road_map, map::LaneId lane);

}  // namespace roadbed::planning::task
