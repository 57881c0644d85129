#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "roadbed/map/model/road_map.h"

namespace roadbed::map::opendrive {

/// A lane as part of a road: whether it drives along the road's s.
struct PlannedLane {
  LaneId lane;
  bool forward = true;
};

/// Lanes side by side, from left to right seen along s.
///
///     lanes[0] │ lanes[1] ║ lanes[2] │ lanes[3]        ║ the middle, lane 0, after `left_lanes`
struct PlannedSection {
  std::vector<PlannedLane> lanes;
  std::size_t left_lanes = 0;
};

/// A road before it has a shape. Only its ends lead to other roads.
struct PlannedRoad {
  std::vector<PlannedSection> sections;  ///< by growing s
  std::optional<RoadId> source;          ///< a road of the map, which then has its reference line
  std::optional<std::uint32_t>
      crossing;  ///< inside which the map says it is, none: it does not say
  bool has_both_ways() const;
};

/// Where a lane is.
struct LanePlaceInPlan {
  std::uint32_t road = 0, section = 0, lane = 0;
};

/// Where a border is: `border` counts from the left edge along s, 0.
struct BorderPlace {
  std::uint32_t road = 0;
  std::size_t section = 0, border = 0;
};

struct RoadPlan {
  std::vector<PlannedRoad> roads;
  std::vector<std::optional<LanePlaceInPlan>> places;  ///< by LaneId; none: the lane is left out
  std::vector<std::string> left_out;                   ///< lanes that no road can hold, and why
  bool left_hand_traffic = false;                      ///< as each road's rule says

  /// A border of a lane that is in the plan.
  BorderPlace border_of(LaneId lane, bool on_left) const;
};

/// Which lanes may be beside one in its road.
enum class Company : std::uint8_t { any, of_its_direction, none, left_out };

/// Groups lanes into roads: a map's own roads as they are, split where a lane leaves one in
/// between, and by direction where the revision cannot say that a lane drives against its side;
/// other lanes with all those beside them, at most one change of direction to a road. Crosswalks
/// are left out: they are objects.
/// @param company  by LaneId.
/// @param minor  of the revision 1.4 to 1.8.
RoadPlan plan_roads(const RoadMap& road_map, const std::vector<Company>& company, int minor);

}  // namespace roadbed::map::opendrive
