#include "roadbed/map/occupancy/outputs/occupancy_changes.h"

#include "roadbed/map/occupancy/octree/cell_grid.h"
#include "roadbed/map/occupancy/outputs/cell_centres.h"

namespace roadbed::map::inline occupancy::inline outputs {
OccupancyChanges changes_between(const OccupancyMap& before, const std::string& before_name,
                                 const OccupancyMap& now, const std::string& now_name) {
  check_one_grid(before, before_name, now, now_name);
  OccupancyChanges changes;
  for (const Eigen::Vector3d& centre : occupied_centres(now, now_name)) {
    if (before.at(centre) == CellState::occupied) {
      ++changes.stayed;
    } else {
      changes.appeared.push_back(centre);
    }
  }
  for (const Eigen::Vector3d& centre : occupied_centres(before, before_name)) {
    const CellState state = now.at(centre);
    if (state == CellState::free) changes.vanished.push_back(centre);
    if (state == CellState::unknown) ++changes.not_seen_again;
  }
  return changes;
}

}  // namespace roadbed::map::occupancy::outputs
