#pragma once

#include <vector>

#include "roadbed/map/occupancy/clouds/point_cloud.h"

namespace roadbed {

/// Scans of a street as a scanner of 64 by 1800 beams sees it from poses 2 m apart: facades, parked
/// cars, poles, trees and the ground, each range with a noise of 1 cm. Seeded: the same every time.
std::vector<map::PointCloud> street_scans(int count);

}  // namespace roadbed
