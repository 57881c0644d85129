#pragma once

#include <Eigen/Geometry>
#include <cstddef>
#include <vector>

#include "roadbed/map/occupancy/octree/occupancy_source.h"

namespace roadbed::tools::inline report {

/// The middle of an occupied cell, in a frame near it, and the cell's size.
struct SizedPoint {
  Eigen::Vector3f place;
  float size_m;
};

/// Occupied cells whose middle lies in a box in plan, each once. Where there are more than `most`,
/// those of the least cells that hold one, twice as large in each direction, and so on.
/// @param origin_in_source  of the frame of the points, whose heights are the source's.
std::vector<SizedPoint> occupied_points(const map::OccupancySource& occupancy,
                                        const Eigen::AlignedBox2d& box_in_source,
                                        const Eigen::Vector2d& origin_in_source,
                                        std::size_t most = std::size_t{1} << 20);

}  // namespace roadbed::tools::report
