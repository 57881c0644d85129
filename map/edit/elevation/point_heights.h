#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "roadbed/map/edit/elevation/elevate.h"
#include "roadbed/map/edit/elevation/height_network.h"

namespace roadbed::map::inline edit::inline elevation {

/// Heights of points that lines connect: those of the ground, and between and beyond these what
/// they had, changed as the points around them are. None: nothing tells.
/// @param in_source  x, y and the height that they have.
/// @param what       the points are called in the counts of what was done: "nodes".
std::vector<std::optional<double>> heights_on(const std::vector<Eigen::Vector3d>& in_source,
                                              const HeightNetwork& lines,
                                              const GroundHeights& ground, const std::string& what,
                                              Edited& result);

/// A height as text, to 0.1 mm.
std::string height_text(double height_m);

}  // namespace roadbed::map::edit::elevation
