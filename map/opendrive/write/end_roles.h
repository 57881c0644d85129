#pragma once

#include <cstdint>
#include <map>
#include <utility>
#include <vector>

#include "roadbed/map/opendrive/write/road_plan.h"

namespace roadbed::map::opendrive {

/// How an end of a road meets others. Ends are 2 · road, + 1 at its end.
enum class EndRole {
  free,       ///< meets none
  plain,      ///< meets one, which meets no other
  hub,        ///< meets several, and all that meet here meet it
  spoke,      ///< meets a hub
  mesh_exit,  ///< lanes leave its road; some that meet here do not meet it
  mesh_entry  ///< lanes enter its road, likewise
};

using LanePairs = std::vector<std::pair<LaneId, LaneId>>;  ///< from, to
/// By the end that is left and the one that is entered.
using EndJoints = std::map<std::pair<std::uint32_t, std::uint32_t>, LanePairs>;

struct EndRoles {
  std::vector<EndRole> roles;          ///< by end
  std::vector<std::uint32_t> groups;   ///< by end: ends that meet have one number
  std::vector<std::uint32_t> partner;  ///< by end: of a plain one, its other
  EndJoints joints;
  std::vector<bool> is_apart;  ///< by road: has both ways and may have only one
  std::size_t lost_links = 0;  ///< of an end with itself
};

EndRoles find_end_roles(const RoadMap& road_map, const RoadPlan& plan);

}  // namespace roadbed::map::opendrive
