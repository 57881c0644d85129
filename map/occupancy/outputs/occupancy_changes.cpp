#include "roadbed/map/occupancy/outputs/occupancy_changes.h"

#include "roadbed/map/occupancy/octree/cell_grid.h"
#include "roadbed/map/occupancy/outputs/cell_centres.h"

namespace roadbed::map::inline occupancy::inline outputs {
OccupancyChanges changes_between(const OccupancyMap& before, const OccupancyMap& now) {
  check_one_grid(before, "octree of before", now, "octree of now");
  OccupancyChanges changes;
  for (const Eigen::Vector3d& centre : occupied_centres(now, "octree of now")) {
    if (before.at(centre) == CellState::occupied) {
      ++changes.stayed;
    } else {
      changes.appeared.push_back(centre);
    }
  }
  for (const Eigen::Vector3d& centre : occupied_centres(before, "octree of before")) {
    const CellState state = now.at(centre);
    if (state == CellState::free) changes.vanished.push_back(centre);
    if (state == CellState::unknown) ++changes.not_seen_again;
  }
  return changes;
}

}  // namespace roadbed::map::occupancy::outputs
