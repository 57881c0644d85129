#pragma once

#include <vector>

#include "roadbed/map/elements/lane.h"

namespace roadbed::map::inline query {

/// A part of a lane between two cross-sections that follow each other, at vertices of its lines.
///
///     left   ●─────┬──●──────┬────●
///     centre ●─────●──┼──────●────●      strips 1, 2, 3, 4
///     right  ●─────┴──┴──────●────●
struct LaneStrip {
  double from_s_m = 0.0, to_s_m = 0.0;
  double area_m2 = 0.0;  ///< of its quadrangle, negative where the borders are swapped
  double width_m = 0.0;  ///< between the borders at its middle, across the centreline
  double start_width_m = 0.0, end_width_m = 0.0;  ///< the same at its ends
  double slope = 0.0;                             ///< of the centreline, positive uphill [m/m]
  double curvature_per_m = 0.0;  ///< of the centreline, that of its more curved end

  double length_m() const { return to_s_m - from_s_m; }
};

/// All strips of a lane in order; their lengths add up to the lane's, and where no border folds
/// their areas to that between the borders. O(N log N) for N vertices.
std::vector<LaneStrip> lane_strips(const Lane& lane);

/// What a lane amounts to along all of it.
struct LaneMeasures {
  double area_m2 = 0.0;
  double least_width_m = 0.0, mean_width_m = 0.0, greatest_width_m = 0.0;
  double greatest_slope = 0.0, greatest_curvature_per_m = 0.0;  ///< both without their sign
};
LaneMeasures measure(const Lane& lane);

}  // namespace roadbed::map::query
