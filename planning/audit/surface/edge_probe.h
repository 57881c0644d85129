#pragma once

// Private to planning/audit: what the audit asks of the edge of a surface.

#include <optional>

#include "roadbed/geometry/motion/body_part.h"
#include "roadbed/geometry/motion/region_edges.h"
#include "roadbed/planning/audit/clearance_probe.h"

namespace roadbed::planning::inline audit {

/// What a distance to a surface's edge is told of.
enum class EdgeSide {
  inside,  ///< from a part that is on the surface; 0 where some of it is off
  either,  ///< from any part; 0 where the edge meets it. Found sooner: nobody asks for the side
};

/// Distances from a part of a vehicle that drives along a trajectory to the edge of a surface.
class EdgeProbe : public ClearanceProbe {
 public:
  EdgeProbe(const geometry::RegionEdges& edges, const geometry::Trajectory& drive,
            const geometry::BodyPart& part, double horizon_m, EdgeSide side = EdgeSide::inside)
      : ClearanceProbe(drive, part.reach_m()),
        edges_(edges),
        part_(part),
        horizon_m_(horizon_m),
        side_(side) {}

  /// The distance itself, where the span is so short that it says something.
  double lower_bound_m(const Span& span, double enough_m) const override;
  std::optional<Near> nearest(const Span& span, double within_m) const override;
  double swept_bound_m(const Span& span, double within_m) const override;
  double horizon_m() const override { return horizon_m_; }
  bool is_continuous() const override { return true; }

  /// The edge that is nearest to a part's core at a pose; where none is within the horizon, a
  /// distance of that and whether it is inside.
  geometry::RegionEdges::Nearest edge_near(const geometry::Rectangle& core) const;

 private:
  std::optional<Near> near(const geometry::Rectangle& core, double within_m) const;
  double room_m(const geometry::Rectangle& core, double within_m) const;

  const geometry::RegionEdges& edges_;
  geometry::BodyPart part_;
  double horizon_m_;
  EdgeSide side_;
};

}  // namespace roadbed::planning::audit
