#include "roadbed/planning/audit/vehicle_audit.h"

#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include "roadbed/planning/audit/audit_report.h"
#include "roadbed/planning/audit/moving_probe.h"
#include "roadbed/planning/audit/observed_space.h"
#include "roadbed/planning/audit/part_audit.h"

namespace roadbed::planning::inline audit {
namespace {

using geometry::BodyPart;

std::string named(const BodyPart& part, const std::string& side) {
  if (side.empty() || part.is_circle()) return side;
  return fmt::format("{}, {}", part.name, side);
}

double volume_m3(const BodyPart& part) {
  return geometry::box_area_m2(part) * (part.to_height_m - part.from_height_m);
}

void take_least(AuditReport& whole, const AuditReport& part) {
  whole.proven_clearance_m = std::min(whole.proven_clearance_m, part.proven_clearance_m);
  if (!(part.least_clearance_m < whole.least_clearance_m)) return;
  whole.least_clearance_m = part.least_clearance_m;
  whole.least_clearance_at_s = part.least_clearance_at_s;
  whole.witness = part.witness;
  whole.obstacle = part.obstacle;
  whole.part = part.part;
  whole.beyond_horizon = part.beyond_horizon;
}

void add(AuditReport& whole, const AuditReport& part) {
  const auto append = [](auto& to, const auto& from) {
    to.insert(to.end(), from.begin(), from.end());
  };
  append(whole.conflicts, part.conflicts);
  append(whole.unknown, part.unknown);
  append(whole.unobserved, part.unobserved);
  append(whole.undecided, part.undecided);
  for (std::size_t i = 0; i < whole.profile.size(); ++i) {
    whole.profile[i].clearance_m =
        std::min(whole.profile[i].clearance_m, part.profile[i].clearance_m);
  }
}

AuditReport with_name(AuditReport report, const BodyPart& part) {
  report.part = named(part, report.part);
  for (Conflict& conflict : report.conflicts) conflict.part = named(part, conflict.part);
  return report;
}

// Least clearances are those of the nearest part, of several equally near the first; the unknown
// fraction is that of the parts' volumes together.
AuditReport merged(const std::vector<BodyPart>& parts, const std::vector<AuditReport>& reports) {
  if (parts.size() == 1) return reports.front();
  AuditReport whole = with_name(reports.front(), parts.front());
  double unknown_m3 = whole.unknown_fraction * volume_m3(parts.front());
  double all_m3 = volume_m3(parts.front());
  for (std::size_t i = 1; i < parts.size(); ++i) {
    const AuditReport report = with_name(reports[i], parts[i]);
    take_least(whole, report);
    add(whole, report);
    unknown_m3 += report.unknown_fraction * volume_m3(parts[i]);
    all_m3 += volume_m3(parts[i]);
  }
  whole.unknown_fraction = unknown_m3 / all_m3;
  std::ranges::stable_sort(whole.conflicts, {}, &Conflict::from_s);
  whole.unknown = joined(std::move(whole.unknown));
  whole.undecided = joined(std::move(whole.undecided));
  std::ranges::stable_sort(whole.unobserved, {}, &UnobservedStretch::from_s);
  whole.observed.clear();
  return whole;
}

// The first band with the same heights.
std::size_t first_alike(const std::vector<map::HeightBand>& bands, std::size_t i) {
  const auto first = std::ranges::find_if(bands, [&](const map::HeightBand& band) {
    return band.from_m == bands[i].from_m && band.to_m == bands[i].to_m;
  });
  return static_cast<std::size_t>(first - bands.begin());
}

}  // namespace

VehicleSurroundings::VehicleSurroundings(const map::OccupancySource& occupancy,
                                         const GroundUnder& ground, std::vector<BodyPart> parts,
                                         const map::FieldRegion& region)
    : occupancy_(&occupancy), surface_(ground.surface), parts_(std::move(parts)) {
  for (const BodyPart& part : parts_) {
    bands_.push_back(ground.band(part.from_height_m, part.to_height_m));
  }
  std::size_t apart = 0;  // bands
  for (std::size_t i = 0; i < bands_.size(); ++i) apart += first_alike(bands_, i) == i;
  // Bands of the same heights share a field; the limit holds for all fields together.
  map::FieldRegion of_each = region;
  of_each.most_cells /= std::max<std::size_t>(1, apart);
  for (std::size_t i = 0; i < bands_.size(); ++i) {
    const std::size_t alike = first_alike(bands_, i);
    fields_.push_back(
        alike < i ? fields_[alike]
                  : std::make_shared<const map::ClearanceField>(occupancy, bands_[i], of_each));
  }
}

VehicleSurroundings::VehicleSurroundings(std::shared_ptr<const map::ClearanceField> field,
                                         std::vector<BodyPart> parts)
    : parts_(std::move(parts)), bands_(parts_.size()), fields_(parts_.size(), std::move(field)) {}

void VehicleSurroundings::explain(const geometry::Trajectory& drive_in_source, std::size_t part,
                                  std::vector<UnobservedStretch>& stretches) const {
  if (occupancy_ == nullptr) return;
  for (UnobservedStretch& stretch : stretches) {
    stretch.reason = why_unobserved(*occupancy_, drive_in_source, {stretch.from_s, stretch.to_s},
                                    parts_[part], bands_[part]);
  }
}

VehicleAudit audit_vehicle(const VehicleSurroundings& around,
                           const geometry::Trajectory& drive_in_source, const AuditOptions& options,
                           std::span<const ObstacleInSource> moving_in_source) {
  std::optional<geometry::Trajectory> changed;
  if (!moving_in_source.empty())
    changed = with_samples_at_changes(drive_in_source, moving_in_source);
  const geometry::Trajectory& drive = changed ? *changed : drive_in_source;
  std::vector<PartInField> parts;
  for (std::size_t i = 0; i < around.parts().size(); ++i) {
    parts.push_back({around.field_of(i), around.parts()[i]});
  }
  VehicleAudit result;
  result.of_parts = audit_parts(parts, drive, options, moving_in_source);
  for (std::size_t i = 0; i < parts.size(); ++i) {
    around.explain(drive, i, result.of_parts[i].unobserved);
  }
  result.whole = judged(merged(around.parts(), result.of_parts), drive);
  return result;
}

std::vector<AuditCertificate> certify_vehicle(const VehicleSurroundings& around,
                                              const geometry::Trajectory& drive_in_source,
                                              const AuditOptions& options,
                                              const VehicleAudit& audit,
                                              std::span<const ObstacleInSource> moving_in_source) {
  std::vector<AuditCertificate> certificates;
  for (std::size_t i = 0; i < around.parts().size(); ++i) {
    certificates.push_back(certify(around.field_of(i), around.band_of(i), drive_in_source,
                                   around.parts()[i], options, audit.of_parts[i],
                                   moving_in_source));
  }
  return certificates;
}

}  // namespace roadbed::planning::audit
