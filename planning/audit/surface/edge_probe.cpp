#include "roadbed/planning/audit/surface/edge_probe.h"

#include <algorithm>

namespace roadbed::planning::inline audit {

using Edge = geometry::RegionEdges::Nearest;

Edge EdgeProbe::edge_near(const geometry::Rectangle& core) const {
  const double within_m = horizon_m_ + part_.radius_m;
  if (const auto found = edges_.nearest(core, within_m)) return *found;
  return {.distance_m = within_m,
          .is_inside = edges_.contains(core.centre),
          .on_edge = core.centre,
          .on_shape = core.centre};
}

// What is nearer than coordinates are rounded counts as outside. None if there is room for
// `within_m`.
std::optional<ClearanceProbe::Near> EdgeProbe::near(const geometry::Rectangle& core,
                                                    double within_m) const {
  const auto found = side_ == EdgeSide::inside ? std::optional(edge_near(core))
                                               : edges_.nearest(core, within_m + part_.radius_m);
  if (!found) return std::nullopt;
  const double beside_m = found->distance_m - part_.radius_m;
  const bool is_room = beside_m > kRounding_m && (side_ == EdgeSide::either || found->is_inside);
  const double distance_m = is_room ? beside_m : 0.0;
  if (distance_m > 0.0 && distance_m >= within_m) return std::nullopt;
  return Near{distance_m, {found->on_edge, found->on_edge}};
}

double EdgeProbe::room_m(const geometry::Rectangle& core, double within_m) const {
  const auto found = near(core, within_m);
  return found ? found->distance_m : within_m;
}

double EdgeProbe::lower_bound_m(const Span& span, double enough_m) const {
  constexpr double most_motion_m = 0.5;  // of longer spans what is swept over says more
  if (motion_bound_m(span) > most_motion_m) return 0.0;
  return room_m(part_.core_at(middle_pose_of(span)), std::min(enough_m, horizon_m_));
}

std::optional<ClearanceProbe::Near> EdgeProbe::nearest(const Span& span, double within_m) const {
  return near(part_.core_at(middle_pose_of(span)), std::min(within_m, horizon_m_));
}

double EdgeProbe::swept_bound_m(const Span& span, double within_m) const {
  constexpr double most_wider_m = 0.3;  // in a bend: a part of the span says more
  if (motion_bound_m(span) > 3.0 * part_.reach_m()) return 0.0;
  const geometry::Rectangle core = swept_over(span, part_);
  if (2.0 * core.half_width_m - part_.width_m() > most_wider_m) return 0.0;
  return room_m(core, std::min(within_m, horizon_m_));
}

}  // namespace roadbed::planning::audit
