#pragma once

#include <string>

#include "roadbed/map/elements/lane.h"

namespace roadbed::map::sumo {

/// Who drives, rides or walks along a lane in SUMO; nobody on shoulders, parking lanes, borders and
/// the like, nor on crosswalks, which SUMO has as parts of junctions.
Participants users_of(const Lane& lane);

/// The vehicle classes of SUMO that these are, in the order of its documentation: "passenger taxi".
std::string vehicle_classes(Participants users);

/// The speed at which a lane is driven [m/s]: its least limit, where the map has none 50 km/h, on
/// ramps 60, as `route` has them.
double speed_mps(const Lane& lane);

}  // namespace roadbed::map::sumo
