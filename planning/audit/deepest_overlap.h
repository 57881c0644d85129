#pragma once

// Private to planning/audit.

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "roadbed/geometry/motion/body_part.h"
#include "roadbed/map/occupancy/clearance/clearance_field.h"
#include "roadbed/planning/audit/audit_report.h"
#include "roadbed/planning/audit/clearance_probe.h"
#include "roadbed/planning/obstacles/obstacle.h"

namespace roadbed::planning::inline audit {

/// How deep a part of a vehicle reaches into what it meets, at moments of a conflict.
class DeepestOverlapSearch {
 public:
  /// @param part       inflated; what is given has to outlive this.
  /// @param conflicts  how many there are: of very many, fewer moments each are looked at.
  DeepestOverlapSearch(const map::ClearanceField& field, const ClearanceProbe& probe,
                       const geometry::BodyPart& part, std::vector<map::ObstacleKind> kinds,
                       std::span<const ObstacleInSource> moving, std::size_t conflicts);

  /// @pre the conflict's least clearance is 0.
  DeepestOverlap of(const Conflict& conflict) const;

 private:
  std::vector<double> moments_s(const Conflict& conflict) const;
  geometry::Overlap with_cells(const geometry::TrajectoryPoint& state) const;
  geometry::Overlap with(const ObstacleInSource& mover,
                         const geometry::TrajectoryPoint& state) const;

  const map::ClearanceField& field_;
  const ClearanceProbe& probe_;
  const geometry::BodyPart& part_;
  std::vector<map::ObstacleKind> kinds_;
  std::span<const ObstacleInSource> moving_;
  double most_moments_;
};

/// The obstacle of an id that is among those that move; null for a cell's empty one.
const ObstacleInSource* find_mover(std::span<const ObstacleInSource> moving, const std::string& id);

}  // namespace roadbed::planning::audit
