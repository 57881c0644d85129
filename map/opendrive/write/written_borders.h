#pragma once

#include <Eigen/Core>
#include <vector>

#include "roadbed/map/opendrive/write/road_shape.h"

namespace roadbed::map::opendrive {

using WrittenLine = std::vector<Eigen::Vector2d>;

/// The borders of a road in plan, evaluated from what is written of it: by written
/// section, from left to right; chords are straight within half a millimetre.
std::vector<std::vector<WrittenLine>> written_borders(const RoadShape& shape);

}  // namespace roadbed::map::opendrive
