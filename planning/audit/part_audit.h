#pragma once

// Private to planning/audit.

#include <cstddef>
#include <memory>
#include <optional>
#include <span>

#include "roadbed/geometry/motion/body_part.h"
#include "roadbed/geometry/motion/trajectory.h"
#include "roadbed/map/occupancy/clearance/clearance_field.h"
#include "roadbed/planning/audit/audit_report.h"
#include "roadbed/planning/audit/body_probe.h"
#include "roadbed/planning/audit/deepest_overlap.h"
#include "roadbed/planning/audit/least_clearance.h"
#include "roadbed/planning/audit/near_stretches.h"
#include "roadbed/planning/audit/observed_space.h"
#include "roadbed/planning/obstacles/obstacle.h"

namespace roadbed::planning::inline audit {

/// The audit of one part of a vehicle, stretch by stretch along the drive: all that is asked about
/// one stretch is asked together, so that parts of one height share the tiles of their field.
class PartAudit {
 public:
  /// As `audit`, which see. What is given has to outlive it.
  /// @param drive_in_source  of `with_samples_at_changes`, where things move.
  PartAudit(const map::ClearanceField& field, const geometry::Trajectory& drive_in_source,
            const geometry::BodyPart& part, const AuditOptions& options,
            std::span<const ObstacleInSource> moving_in_source);
  PartAudit(const PartAudit&) = delete;
  PartAudit& operator=(const PartAudit&) = delete;

  /// Audits all parts of a vehicle, which are on the same drive.
  static void sweep(std::span<const std::unique_ptr<PartAudit>> parts);

  /// Whether enough was measured is not judged yet.
  /// @pre The part has gone along the drive.
  AuditReport report();

 private:
  void advance(std::size_t from, std::size_t to);
  void take_samples(std::size_t to);
  void take_unknown_fractions(std::size_t to);
  void take_least(const LeastClearance& least);
  bool is_near(const LeastClearance& least) const;
  void collect_conflicts(const Probe& probe);
  void audit_moving();
  void collect_unobserved();
  void describe_conflicts();

  const map::ClearanceField& field_;
  const AuditOptions& options_;
  std::span<const ObstacleInSource> moving_;
  geometry::BodyPart part_;  // of the vehicle
  geometry::BodyPart body_;  // inflated
  const geometry::Trajectory& drive_;
  BodyProbe probe_;
  LeastClearanceSearch least_;
  std::optional<BodyProbe> unknown_probe_;  // where unknown space is reported
  std::optional<NearStretchSearch> unknown_;
  ObservedSearch observed_;
  std::size_t poses_ = 0;
  double unknown_sum_ = 0.0;  // of the poses' fractions
  AuditReport report_;
};

}  // namespace roadbed::planning::audit
