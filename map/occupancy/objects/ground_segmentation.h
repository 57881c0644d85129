#pragma once

#include <vector>

#include "roadbed/map/occupancy/clouds/point_cloud.h"

namespace roadbed::map::inline occupancy::inline objects {

/// How the ground of a cloud is told from what stands on it.
struct GroundOptions {
  double cell_m = 1.0;         ///< of the grid of lowest points that is looked at
  double slope = 0.3;          ///< the steepest ground, rise over run
  double most_height_m = 0.3;  ///< what is higher over the ground is none …
  double widest_m = 20.0;      ///< the narrower side of the largest object that is no ground

  /// … and where it is level, already what is higher than this.
  double least_height_m() const { return most_height_m * 2.0 / 3.0; }
};

/// Which points of a cloud are ground, and how high the others are above it.
struct GroundSegmentation {
  std::vector<bool> is_ground;  ///< per point
  /// Per point, above the ground's point that is nearest in plan [m]; 0 of the ground itself.
  std::vector<float> heights_m;
};

/// Segments the ground by PCL's ApproximateProgressiveMorphologicalFilter [Zhang et al. 2003,
/// doi:10.1109/TGRS.2003.810682]: the lowest points of a grid are opened with windows that double
/// up to `widest_m`; what stands out is no ground. Heights are those above the plane that most of
/// the lowest points lie on (RANSAC), so that a slope is ground up to where the cloud ends; what
/// rises over that plane towards the cloud's end is ground only as far as `most_height_m` allows.
/// It asks for nothing below a surface, and not for a surface all around, but for ground within
/// that width of everything. O(N log N).
/// @throws InputError if roadbed was built without PCL, no point is ground, or the cloud reaches
///         over more than four million cells, for which the filter would take minutes.
GroundSegmentation segment_ground(const PointCloud& cloud, const GroundOptions& options = {});

}  // namespace roadbed::map::occupancy::objects
