#pragma once

#include <string>

#include "roadbed/map/model/road_map.h"

namespace roadbed::map::inline gis {

/// The lines of all lanes as CSV, a row per vertex, lanes in order of id, per lane left, right and
/// centre: `road,section,lane,type,line,s_m,x_m,y_m,z_m`. x and y are source coordinates; numbers
/// are the shortest that read back as the same double; fields are quoted as in RFC 4180.
///
/// Road areas without lanes follow as their centrelines ("area 1", …, type "other"), with borders
/// half the area's width to either side; s_m runs along the centreline, z is 0.
std::string write_csv(const RoadMap& road_map);

}  // namespace roadbed::map::gis
