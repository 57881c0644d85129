#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "roadbed/map/model/road_map.h"

namespace roadbed::map::inline drawing {

/// A place to point at, with a text that shows when the mouse rests on it.
struct SvgMark {
  Eigen::Vector2d in_map{0, 0};
  std::string colour;
  std::string title;
};

struct SvgOptions {
  /// The size that the least widths of lines are chosen for, of the longer side of the map's
  /// picture, caption not counted. The picture itself has no size: it fills the window.
  double longer_side_px = 1600.0;
  std::vector<SvgMark> marks;  ///< drawn over the map, the last one on top
};

/// A picture of the map for people: surfaces by lane type, bridges above what they cross, junctions
/// tinted, markings as they are painted, driving directions, crosswalks, stop lines, signals, a
/// grid, scale bar and legend. Where the pointer is, a browser names the lane. One user unit is a
/// metre; the element `desc` says how the picture's coordinates follow from the source's. Lines are
/// drawn to within a twentieth of a pixel.
std::string write_svg(const RoadMap& road_map, const SvgOptions& options = {});

}  // namespace roadbed::map::drawing
