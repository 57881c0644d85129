#include "roadbed/planning/audit/audit_drive.h"

#include <algorithm>
#include <utility>

namespace roadbed::planning::inline audit {
namespace {

// How far the vehicle reaches, with the margin.
map::BodyReach reach_of(const AuditQuestion& question) {
  map::BodyReach reach;
  for (const geometry::BodyPart& part : question.parts) {
    const double grown_m = part.radius_m + question.options.inflate_m;
    reach.rear_m = std::min(reach.rear_m, part.rear_m - grown_m);
    reach.front_m = std::max(reach.front_m, part.front_m + grown_m);
  }
  return reach;
}

void audit_within(const VehicleSurroundings& around, const geometry::Trajectory& drive_in_source,
                  const AuditQuestion& question, DriveAudit& audit) {
  VehicleAudit found =
      audit_vehicle(around, drive_in_source, question.options, question.moving_in_source);
  if (question.certifies) {
    audit.certificates = certify_vehicle(around, drive_in_source, question.options, found,
                                         question.moving_in_source);
  }
  audit.report = std::move(found.whole);
}

}  // namespace

map::HeightBand AuditQuestion::heights(const GroundUnder& under) const {
  map::HeightBand all{parts.front().from_height_m, parts.front().to_height_m};
  for (const geometry::BodyPart& part : parts) {
    all = {std::min(all.from_m, part.from_height_m), std::max(all.to_m, part.to_height_m)};
  }
  return under.band(all.from_m, all.to_m);
}

GroundUnder AuditQuestion::ground_of(const map::OccupancySource& occupancy,
                                     const geometry::Trajectory& drive_in_source) const {
  return ground_under(occupancy, drive_in_source, ground, reach_of(*this));
}

std::vector<geometry::BodyPart> AuditQuestion::inflated_parts() const {
  std::vector<geometry::BodyPart> inflated;
  for (const geometry::BodyPart& part : parts) {
    inflated.push_back(geometry::inflated(part, options.inflate_m));
  }
  return inflated;
}

DriveAudit audit_drive(const map::OccupancySource& occupancy,
                       const geometry::Trajectory& drive_in_source, const AuditQuestion& question,
                       const std::function<void(const GroundUnder&)>& on_ground) {
  GroundUnder ground = question.ground_of(occupancy, drive_in_source);
  if (on_ground) on_ground(ground);
  const VehicleSurroundings around(
      occupancy, ground, question.parts,
      audited_region(drive_in_source, question.parts, question.options));
  return audit_drive(around, std::move(ground), drive_in_source, question);
}

DriveAudit audit_drive(const VehicleSurroundings& around, GroundUnder ground,
                       const geometry::Trajectory& drive_in_source, const AuditQuestion& question) {
  DriveAudit audit{.ground = std::move(ground)};
  audit_within(around, drive_in_source, question, audit);
  return audit;
}

DriveAudit audit_drive(std::shared_ptr<const map::ClearanceField> field,
                       const geometry::Trajectory& drive_in_source, const AuditQuestion& question) {
  DriveAudit audit;
  audit_within({std::move(field), question.parts}, drive_in_source, question, audit);
  return audit;
}

void leave_unknown(const std::vector<Stretch>& between_poses, DriveAudit& audit) {
  audit.report = judged_between_poses(std::move(audit.report), between_poses);
  for (AuditCertificate& certificate : audit.certificates) {
    auto& unknown = certificate.unknown;
    unknown.insert(unknown.end(), between_poses.begin(), between_poses.end());
    unknown = joined(std::move(unknown));
    certificate.verdict = verdict_of(certificate);
  }
}

}  // namespace roadbed::planning::audit
