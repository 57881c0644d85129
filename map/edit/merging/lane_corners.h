#pragma once

#include <Eigen/Core>
#include <map>
#include <pugixml.hpp>
#include <vector>

#include "roadbed/map/elements/lane.h"

namespace roadbed::map::inline edit::inline merging {

/// Where a lane ends: the ends of its two borders, as a map has them.
struct LaneCorners {
  LaneType type = LaneType::none;
  Eigen::Vector3d inner, outer;  ///< towards the road's middle, and away from it
};

/// How far two lanes' corners are apart, the greater distance of the two.
double distance_m(const LaneCorners& a, const LaneCorners& b);

/// What a road of OpenDRIVE is like at one of its ends.
struct RoadEndShape {
  double height_m = 0.0;  ///< of the reference line
  std::map<int, LaneCorners> lanes;
};

struct RoadEndPlace {
  pugi::xml_node road;
  bool at_start = true;
};

/// The shapes of ends of roads, x and y from a point that all have in common. Lanes are those of
/// the section at the end; a road that no map can have has none.
std::vector<RoadEndShape> shapes_of(const std::vector<RoadEndPlace>& ends);

}  // namespace roadbed::map::edit::merging
