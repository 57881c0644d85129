#pragma once

#include <string>

#include "roadbed/map/road_map.h"

namespace roadbed::map {

struct SvgOptions {
  /// The size that the least widths of lines are chosen for, of the longer side of the map's
  /// picture, caption not counted. The picture itself has no size: it fills the window.
  double longer_side_px = 1600.0;
};

/// A picture of the map for people: surfaces by lane type, bridges above what they cross, junctions
/// tinted, markings as they are painted, driving directions, crosswalks, stop lines, signals, a
/// grid, scale bar and legend. Where the pointer is, a browser names the lane. One user unit is a
/// metre; the element `desc` says how the picture's coordinates follow from the source's. Lines are
/// drawn to within a twentieth of a pixel.
std::string write_svg(const RoadMap& road_map, const SvgOptions& options = {});

}  // namespace roadbed::map
