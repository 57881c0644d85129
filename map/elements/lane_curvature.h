#pragma once

#include "roadbed/map/elements/lane.h"

namespace roadbed::map::inline elements {

/// Curvature of a lane's centreline about a station [1/m], positive to the left; 0 within `chord_m`
/// of the lane's ends. It is the turn between two chords of that length, by the length of the bend
/// that they stand for. A line drawn by few points turns at them for the whole bend between them,
/// which then is as long as the segments of the borders there: those of the centreline end between
/// the borders' points, too, where it does not turn. A line can stand for a bend to a quarter of a
/// metre only; where an arc between the points would be farther off its chord, the bend is shorter.
///
/// O(log vertices).
double curvature_about_per_m(const Lane& lane, double s_m, double chord_m);

}  // namespace roadbed::map::elements
