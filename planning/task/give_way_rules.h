#pragma once

#include <string_view>

#include "roadbed/map/derived/rule_index.h"
#include "roadbed/map/model/road_map.h"

namespace roadbed::planning::inline task {

/// Signs that ask to stop or to give way, by their type or subtype: Germany's StVO 206 and 205,
/// the MUTCD's R1-1 and R1-2, with or without a country before it.
bool is_stop_sign(const map::Signal& signal);
bool is_give_way_sign(const map::Signal& signal);

/// Whether one of the two stands on a lane, by rules that were asked of it.
bool has_sign_to_give_way(const map::RoadMap& road_map, const map::RuleIndex& rules,
                          map::LaneId lane);

/// Whether a regulation "right_of_way" names a lane in a role: "yield" or "right_of_way".
bool has_priority_role(const map::Regulation& regulation, std::string_view role, map::LaneId lane);

}  // namespace roadbed::planning::task
