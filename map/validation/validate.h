#pragma once

#include <span>
#include <vector>

#include "roadbed/map/model/road_map.h"
#include "roadbed/map/validation/rule.h"

namespace roadbed::map::validation {

/// Every fault of a map, in order of rule and element. Never throws over a faulty map.
std::vector<Finding> validate(const RoadMap& road_map, const ValidateOptions& options = {});

// Rules about a map, whatever its format: one function each, one source file per theme. Each adds
// its findings in order of lanes.

struct MapRule {
  RuleInfo info;
  void (*check)(const RoadMap& road_map, const ValidateOptions& options, Report& report);
};

std::span<const MapRule> continuity_rules();  ///< where one lane leads to the next
std::span<const MapRule> border_rules();      ///< the shape of one lane
std::span<const MapRule> link_rules();        ///< how lanes are linked
std::span<const MapRule> neighbour_rules();   ///< lanes side by side
std::span<const MapRule> surface_rules();     ///< lanes on top of each other, or far away
std::span<const MapRule> attribute_rules();   ///< what lanes and the map say of themselves
std::span<const MapRule> furniture_rules();   ///< signals, stop lines, objects

/// All of the above.
std::vector<MapRule> map_rules();

/// What readers remark.
std::span<const RuleInfo> import_rules();

}  // namespace roadbed::map::validation
