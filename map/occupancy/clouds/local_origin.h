#pragma once

// Private to map/occupancy.

#include "roadbed/map/occupancy/clouds/cloud_formats.h"
#include "roadbed/map/occupancy/clouds/point_cloud.h"

namespace roadbed::map::inline occupancy::inline clouds {

/// The cloud of what a file holds, with the local origin that `PointCloud` names; its own name is
/// not set. @pre there is a point.
PointCloud relative_to_origin(RawCloud raw);

}  // namespace roadbed::map::occupancy::clouds
