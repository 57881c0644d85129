#include "roadbed/tools/audit/drive_groups.h"

#include <algorithm>

#include "roadbed/map/occupancy/clearance/clearance_field.h"

namespace roadbed::tools::inline audit {
namespace {

double cells_of(const map::FieldRegion& region, double cell_m) {
  const Eigen::Vector2d held = region.around.max_in_source - region.around.min_in_source;
  return (held.array() + 2.0 * region.horizon_m).prod() / (cell_m * cell_m);
}

map::FieldRegion joined(map::FieldRegion region, const map::Box2& with) {
  region.around = {region.around.min_in_source.cwiseMin(with.min_in_source),
                   region.around.max_in_source.cwiseMax(with.max_in_source)};
  return region;
}

bool are_same_level(const planning::GroundUnder& a, const planning::GroundUnder& b) {
  return !a.surface && !b.surface && a.level_m == b.level_m && a.margin_m == b.margin_m;
}

bool takes(const DriveGroup& group, const DriveExtent& drive, double cell_m) {
  if (!are_same_level(group.ground, drive.ground)) return false;
  const double together = cells_of(joined(group.region, drive.region.around), cell_m);
  const std::size_t most = std::min(map::ClearanceField::kMostOfOneGrid, group.region.most_cells);
  return together <= static_cast<double>(most) &&
         together <= cells_of(group.region, cell_m) + cells_of(drive.region, cell_m);
}

}  // namespace

std::vector<DriveGroup> drive_groups(const std::vector<DriveExtent>& drives, double cell_m) {
  std::vector<DriveGroup> groups;
  for (const DriveExtent& drive : drives) {
    const auto group = std::ranges::find_if(
        groups, [&](const DriveGroup& one) { return takes(one, drive, cell_m); });
    if (group == groups.end()) {
      groups.push_back({{drive.drive}, drive.ground, drive.region});
    } else {
      group->drives.push_back(drive.drive);
      group->region = joined(group->region, drive.region.around);
    }
  }
  return groups;
}

}  // namespace roadbed::tools::audit
