#pragma once

#include <Eigen/Core>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "roadbed/map/edit/edited.h"

namespace roadbed::map::inline edit::inline elevation {

/// Heights of the ground at points in the map's source coordinates; none where it is not known.
using GroundHeights =
    std::function<std::vector<std::optional<double>>(std::span<const Eigen::Vector2d> in_source)>;

/// A map on the ground, as a file of its own format: x and y, ids and links stay. Where the ground
/// is not known, what changes is spread along the lines, so that heights go on from those known
/// without a step (height_network.h); what no line connects with any stays as it is.
/// @throws InputError if the file is unusable, or of a format that cannot be edited.
Edited elevate(std::string bytes, const std::string& name, const GroundHeights& ground);

// Of one format.
//
// OpenDRIVE: a profile of elevation and one of superelevation in place of all that a road had of
// these, of crossfall and of lateral shapes. Every 2 m (maps of over 200 km: farther apart) the
// line of least squares goes through the ground at five points between the outermost borders of the
// carriageway; cubics go through these lines to within 2 mm of the outermost border. Ends of
// reference lines that are at one place get one height, and one slope across if they point in one
// direction.
Edited elevate_open_drive(std::string bytes, const std::string& name, const GroundHeights& ground);

// Lanelet2: the tag `ele` of nodes.
Edited elevate_lanelet2(std::string bytes, const std::string& name, const GroundHeights& ground);

// CommonRoad: `<z>` of the points of borders and stop lines. All points of a lanelet have one then.
Edited elevate_common_road(std::string bytes, const std::string& name, const GroundHeights& ground);

}  // namespace roadbed::map::edit::elevation
