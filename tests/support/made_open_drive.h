#pragma once

#include <string>

#include "roadbed/map/model/road_map.h"

namespace roadbed::tests {

/// An OpenDRIVE file of one road: line, spiral, arc, spiral, poly3 and paramPoly3 with lanes of
/// changing width, lane offset, elevation, superelevation, two sections and a signal.
std::string curved_road_xml();

/// The same as a map.
map::RoadMap curved_two_lane_road();

}  // namespace roadbed::tests
