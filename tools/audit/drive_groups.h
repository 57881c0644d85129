#pragma once

#include <cstddef>
#include <vector>

#include "roadbed/map/occupancy/clearance/field_region.h"
#include "roadbed/planning/audit/ground_under.h"

namespace roadbed::tools::inline audit {

/// Where a drive is and what its heights are above.
struct DriveExtent {
  std::size_t drive;  ///< its number
  planning::GroundUnder ground;
  map::FieldRegion region;  ///< all have the same horizon and radius of bodies
};

/// Drives whose audits share the occupied space around them.
struct DriveGroup {
  std::vector<std::size_t> drives;
  planning::GroundUnder ground;  ///< of each
  map::FieldRegion region;       ///< around all
};

/// Puts drives over the same level together where that takes no more cells than each by itself, and
/// one grid is enough (`ClearanceField::kMostOfOneGrid`, and the region's own limit). Each drive is
/// in one group; what is above a ground that is not level is in one of its own. Of the groups that
/// a drive fits in it joins the first, in the order of the list. O(drives × groups).
/// @param cell_m  side of a cell.
std::vector<DriveGroup> drive_groups(const std::vector<DriveExtent>& drives, double cell_m);

}  // namespace roadbed::tools::audit
