#pragma once

#include <memory>
#include <span>
#include <vector>

#include "roadbed/geometry/motion/body_part.h"
#include "roadbed/map/occupancy/clearance/clearance_field.h"
#include "roadbed/map/occupancy/octree/occupancy_source.h"
#include "roadbed/planning/audit/certificate.h"
#include "roadbed/planning/audit/clearance_audit.h"
#include "roadbed/planning/audit/ground_under.h"

namespace roadbed::planning::inline audit {

/// The parts of a vehicle, each with the occupied space of its own heights above the ground.
class VehicleSurroundings {
 public:
  /// Parts of the same heights share a field, and all fields the region's cells.
  /// @param occupancy  kept by reference.
  /// @param ground     what the parts' heights are above.
  /// @throws InputError if a field would have too many cells.
  VehicleSurroundings(const map::OccupancySource& occupancy, const GroundUnder& ground,
                      std::vector<geometry::BodyPart> parts, const map::FieldRegion& region);

  /// The same field for all parts.
  VehicleSurroundings(std::shared_ptr<const map::ClearanceField> field,
                      std::vector<geometry::BodyPart> parts);

  const std::vector<geometry::BodyPart>& parts() const { return parts_; }
  const map::ClearanceField& field_of(std::size_t part) const { return *fields_[part]; }
  const map::HeightBand& band_of(std::size_t part) const { return bands_[part]; }

  /// Says of each stretch of a part why it is unobserved, where the occupancy is known.
  void explain(const geometry::Trajectory& drive_in_source, std::size_t part,
               std::vector<UnobservedStretch>& stretches) const;

 private:
  const map::OccupancySource* occupancy_ = nullptr;
  std::shared_ptr<const map::Ground> surface_;  // of the bands
  std::vector<geometry::BodyPart> parts_;
  std::vector<map::HeightBand> bands_;                              // of each part
  std::vector<std::shared_ptr<const map::ClearanceField>> fields_;  // of each part
};

/// What the audits of a vehicle's parts found, and what that means for the whole.
struct VehicleAudit {
  std::vector<AuditReport> of_parts;
  AuditReport whole;  ///< conflicts of several parts may overlap in time
};

/// Audits each part by itself: a vehicle keeps clear if all its parts do.
VehicleAudit audit_vehicle(const VehicleSurroundings& around,
                           const geometry::Trajectory& drive_in_source, const AuditOptions& options,
                           std::span<const ObstacleInSource> moving_in_source = {});

/// A certificate for each part.
/// @pre `audit` is what `audit_vehicle` says of the same.
std::vector<AuditCertificate> certify_vehicle(
    const VehicleSurroundings& around, const geometry::Trajectory& drive_in_source,
    const AuditOptions& options, const VehicleAudit& audit,
    std::span<const ObstacleInSource> moving_in_source = {});

}  // namespace roadbed::planning::audit
