#pragma once

#include "roadbed/map/commonroad/document.h"
#include "roadbed/map/model/road_map.h"

namespace roadbed::map::commonroad {

/// The road network of a CommonRoad file (XML formats 2018b and 2020a). What moves on it is read by
/// `parse_scenario` of scenario.h.
/// @throws InputError with the place in the file if it is unusable.
RoadMapParts read(const Document& document);

}  // namespace roadbed::map::commonroad
