#pragma once

#include "roadbed/map/elements/lane.h"

namespace roadbed::map::inline elements {

/// The polygon between a lane's borders, counter-clockwise and simple: of a ring that folds over
/// itself the largest part is kept. Empty if nothing of it has an area, or it folds without end.
geometry::Ring lane_ring(const geometry::Polyline& left_in_map,
                         const geometry::Polyline& right_in_map);

/// The same for any closed ring of points.
geometry::Ring simple_ring(geometry::Ring ring);

}  // namespace roadbed::map::elements
