#pragma once

#include <string>

#include "roadbed/map/road_map.h"

namespace roadbed::map {

struct SvgOptions {
  double longer_side_px = 1600.0;  ///< of the map's picture, caption not counted
};

/// A picture of the map for people: surfaces by lane type, junctions tinted, lane markings,
/// driving directions, signals, a scale bar and a caption. One user unit is a metre; the element
/// `desc` says how the picture's coordinates follow from the source's. Lines are drawn to within a
/// twentieth of a pixel.
std::string write_svg(const RoadMap& road_map, const SvgOptions& options = {});

}  // namespace roadbed::map
