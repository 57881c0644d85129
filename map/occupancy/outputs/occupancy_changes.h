#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <string>
#include <vector>

#include "roadbed/map/occupancy/octree/occupancy_map.h"

namespace roadbed::map::inline occupancy::inline outputs {

/// What is different in space that is measured anew, in cells of the finest size.
struct OccupancyChanges {
  std::vector<Eigen::Vector3d> appeared;  ///< centres of cells occupied now and not before
  std::vector<Eigen::Vector3d> vanished;  ///< occupied before and free now
  std::size_t not_seen_again = 0;         ///< occupied before and unknown now
  std::size_t stayed = 0;                 ///< occupied then and now

  bool any() const { return !appeared.empty() || !vanished.empty(); }
};

/// Both octrees are asked at the centres of the other's cells.
/// @throws InputError if they are of different resolution or coordinate system, or their cells are
///         not in one grid.
/// @param before_name, now_name  of their files, for messages.
OccupancyChanges changes_between(const OccupancyMap& before, const std::string& before_name,
                                 const OccupancyMap& now, const std::string& now_name);

}  // namespace roadbed::map::occupancy::outputs
