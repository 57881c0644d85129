#include "roadbed/map/occupancy/clearance/field_region.h"

#include <algorithm>

#include "roadbed/map/occupancy/ground/ground.h"

namespace roadbed::map::inline occupancy::inline clearance {

bool HeightBand::holds(const Eigen::Vector2d& in_source, double low_m, double height_m) const {
  constexpr double touch_m = 1e-6;  // what overlaps the band by less only touches it
  const double above_m = ground ? low_m - ground->height_m(in_source) : low_m;
  return std::min(above_m + height_m, to_m) - std::max(above_m, from_m) > touch_m;
}

}  // namespace roadbed::map::occupancy::clearance
