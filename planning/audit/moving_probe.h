#pragma once

// Private to planning/audit: what the audit asks of obstacles that move.

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "roadbed/geometry/motion/body_part.h"
#include "roadbed/geometry/motion/trajectory.h"
#include "roadbed/planning/audit/clearance_probe.h"
#include "roadbed/planning/obstacles/obstacle.h"

namespace roadbed::planning::inline audit {

/// The same drive with a sample more at each time at which an obstacle comes or goes, so that each
/// is there all through a segment, or not at all. One that is there only at the first or the last
/// moment of the drive counts all through its first or last segment.
geometry::Trajectory with_samples_at_changes(const geometry::Trajectory& drive,
                                             std::span<const ObstacleInSource> obstacles);

/// Distances from a part of a vehicle that drives along a trajectory to rectangles that move:
/// linear between their samples, at rest before the first and after the last.
class MovingProbe : public ClearanceProbe {
 public:
  /// O((obstacles + near ones of all segments) · log(segments)).
  /// @param drive  of `with_samples_at_changes`.
  MovingProbe(const geometry::Trajectory& drive, const geometry::BodyPart& part,
              std::span<const ObstacleInSource> obstacles, double horizon_m);

  /// Also the way of the fastest of the obstacles there.
  double motion_bound_m(const Span& span) const override;
  double lower_bound_m(const Span& span, double enough_m) const override;
  std::optional<Near> nearest(const Span& span, double within_m) const override;
  double horizon_m() const override { return horizon_m_; }
  /// Not where what moves comes and goes.
  bool is_continuous() const override { return false; }

 private:
  struct Mover {
    const ObstacleInSource* from;
    double radius_m;
    std::vector<double> way_m;  // of its farthest corner up to each sample, along its motion
  };

  bool is_there(const Mover& mover, std::size_t segment) const;
  static double way_until_m(const Mover& mover, double t_s);
  double apart_m(const Mover& mover, const Span& span) const;
  bool may_be_near(const Mover& mover, const Span& span) const;
  bool is_near(const Mover& mover, std::size_t segment) const;
  void find_near(const Span& span, const std::vector<std::size_t>& candidates);

  geometry::BodyPart part_;
  double horizon_m_, body_radius_m_;
  std::vector<Mover> movers_;
  std::vector<std::vector<std::size_t>> near_;  // of each segment: what may be within the horizon
};

}  // namespace roadbed::planning::audit
