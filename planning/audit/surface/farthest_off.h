#pragma once

#include <Eigen/Core>

#include "roadbed/geometry/motion/body_part.h"
#include "roadbed/geometry/motion/region_edges.h"
#include "roadbed/geometry/primitives/pose2.h"

namespace roadbed::planning::inline audit {

/// A point of a body, and how far it is off a surface.
struct FarthestOff {
  double depth_m = 0.0;  ///< 0: none is off; `kSurfaceHorizon_m`: so far, or farther
  Eigen::Vector2d point{0, 0}, edge{0, 0};
};

/// The farthest of a part's corners and points between them. O(points · log edges).
/// @param apart_m  of neighbouring points, at most; 200 in a line are enough.
FarthestOff farthest_off(const geometry::RegionEdges& edges, const geometry::BodyPart& part,
                         const geometry::Pose2& pose, double apart_m);

}  // namespace roadbed::planning::audit
