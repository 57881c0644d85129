#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "roadbed/map/opendrive/write/road_plan.h"

namespace roadbed::map::opendrive {

/// The line across a road where it begins or ends: through a point, and the heading of the road
/// there, along s.
struct EndLine {
  Eigen::Vector2d in_map{0, 0};
  double heading_rad = 0.0;
};

/// Lines across both ends of every road. Roads that join each other have one line there: the one
/// through all ends of their lanes' borders if these are in line and not too askew; else one that
/// is square to the lanes, of roads that lead into a junction where all their borders still go on,
/// so that what is cut off is the beginning of every road behind it.
std::vector<std::array<EndLine, 2>> end_lines(const RoadMap& road_map, const RoadPlan& plan);

}  // namespace roadbed::map::opendrive
