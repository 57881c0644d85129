#include "roadbed/planning/audit/surface/farthest_off.h"

#include <algorithm>
#include <cmath>

#include "roadbed/planning/audit/surface/road_surface.h"

namespace roadbed::planning::inline audit {
namespace {

using Eigen::Vector2d;

// A circle's points lie around its middle: the farthest one off is opposite to the nearest edge.
void take(const geometry::RegionEdges& edges, double radius_m, const Vector2d& middle,
          FarthestOff& best) {
  const auto edge = edges.nearest(middle, kSurfaceHorizon_m);
  if (!edge) {
    if (edges.contains(middle) || best.depth_m >= kSurfaceHorizon_m) return;
    best = {kSurfaceHorizon_m, middle, middle};
    return;
  }
  const double depth_m = (edge->is_inside ? -edge->distance_m : edge->distance_m) + radius_m;
  if (!(depth_m > best.depth_m)) return;
  const Vector2d out = (edge->is_inside ? 1.0 : -1.0) * (edge->on_edge - middle);
  best.depth_m = depth_m;
  best.point = out.norm() > 0.0 ? Vector2d(middle + radius_m * out.normalized()) : middle;
  best.edge = edge->on_edge;
}

}  // namespace

FarthestOff farthest_off(const geometry::RegionEdges& edges, const geometry::BodyPart& part,
                         const geometry::Pose2& pose, double apart_m) {
  constexpr double most = 200.0;
  const geometry::Rectangle core = part.core_at(pose);
  const Vector2d left(-core.axis.y(), core.axis.x());
  const auto steps = [&](double half_m) {
    return std::clamp(std::ceil(2.0 * half_m / apart_m), 1.0, most);
  };
  FarthestOff best{.point = core.centre, .edge = core.centre};
  const double along = steps(core.half_length_m), across = steps(core.half_width_m);
  for (double i = 0.0; i <= along; ++i) {
    for (double k = 0.0; k <= across; ++k) {
      const Vector2d point = core.centre +
                             (2.0 * i / along - 1.0) * core.half_length_m * core.axis +
                             (2.0 * k / across - 1.0) * core.half_width_m * left;
      take(edges, part.radius_m, point, best);
    }
  }
  return best;
}

}  // namespace roadbed::planning::audit
