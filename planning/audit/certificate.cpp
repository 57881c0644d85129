#include "roadbed/planning/audit/certificate.h"

#include <algorithm>
#include <limits>
#include <optional>
#include <utility>

#include "roadbed/planning/audit/body_probe.h"
#include "roadbed/planning/audit/moving_probe.h"
#include "roadbed/planning/audit/proven_cover.h"

namespace roadbed::planning::inline audit {
namespace {

using map::ObstacleKind;

constexpr double kMostCertified_m = 5.0;  // more room than this would only make more spans

std::vector<Stretch> in_order(std::vector<Stretch> stretches) {
  std::sort(stretches.begin(), stretches.end(),
            [](const Stretch& a, const Stretch& b) { return a.from_s < b.from_s; });
  return stretches;
}

std::vector<Stretch> without_proof(const AuditReport& report) {
  std::vector<Stretch> stretches = report.undecided;
  for (const Conflict& conflict : report.conflicts) {
    stretches.push_back({conflict.from_s, conflict.to_s});
  }
  return in_order(std::move(stretches));
}

template <typename Span>
double least_of(const std::vector<Span>& spans) {
  double least_m = std::numeric_limits<double>::infinity();
  for (const Span& span : spans) least_m = std::min(least_m, span.at_least_m);
  return least_m;
}

std::vector<ProvenTime> in_time(const ClearanceProbe& probe, const std::vector<ProvenSpan>& spans) {
  std::vector<ProvenTime> times;
  for (const ProvenSpan& span : spans) {
    times.push_back({probe.time_at(span.segment, span.from), probe.time_at(span.segment, span.to),
                     span.at_least_m});
  }
  return times;
}

void add_to(std::vector<Stretch>& stretches, const std::vector<Stretch>& more) {
  stretches.insert(stretches.end(), more.begin(), more.end());
  stretches = in_order(std::move(stretches));
}

}  // namespace

AuditCertificate certify(const map::ClearanceField& field, const map::HeightBand& band,
                         const geometry::Trajectory& drive_in_source,
                         const geometry::BodyPart& part, const AuditOptions& options,
                         const AuditReport& report,
                         std::span<const ObstacleInSource> moving_in_source) {
  const geometry::BodyPart body = geometry::inflated(part, options.inflate_m);
  const auto cover = [&](ObstacleKind kind, double goal_m, const std::vector<Stretch>& left_out) {
    const BodyProbe probe(field, drive_in_source, body, {kind});
    return proven_cover(probe, goal_m, left_out);
  };
  AuditCertificate certificate{.part = part,
                               .band = band,
                               .clearance_m = options.clearance_m,
                               .inflate_m = options.inflate_m,
                               .unknown_policy = options.unknown,
                               .from_occupied = {},
                               .from_unknown = {},
                               .from_moving = {},
                               .observed = report.observed,
                               .measured_fraction = 1.0 - report.unknown_fraction,
                               .conflicts = report.conflicts,
                               .unknown = report.unknown,
                               .undecided = report.undecided};
  const std::vector<Stretch> left_out = without_proof(report);
  const double goal_m =
      std::max(options.clearance_m,
               std::min(report.proven_clearance_m - options.tolerance_m, kMostCertified_m));

  ProvenCover from_occupied = cover(ObstacleKind::occupied, goal_m, left_out);
  certificate.from_occupied = std::move(from_occupied.proven);
  add_to(certificate.undecided, from_occupied.left);
  double least_m = least_of(certificate.from_occupied);
  if (options.unknown == UnknownPolicy::occupied) {
    ProvenCover from_unknown = cover(ObstacleKind::unknown, goal_m, left_out);
    certificate.from_unknown = std::move(from_unknown.proven);
    add_to(certificate.undecided, from_unknown.left);
    least_m = std::min(least_m, least_of(certificate.from_unknown));
  } else if (options.unknown == UnknownPolicy::report) {
    ProvenCover from_unknown = cover(ObstacleKind::unknown, options.clearance_m, report.unknown);
    certificate.from_unknown = std::move(from_unknown.proven);
    add_to(certificate.unknown, from_unknown.left);
  }
  if (!moving_in_source.empty()) {
    const geometry::Trajectory drive = with_samples_at_changes(drive_in_source, moving_in_source);
    const MovingProbe probe(drive, body, moving_in_source, field.horizon_m());
    const ProvenCover from_moving = proven_cover(probe, goal_m, left_out);
    certificate.from_moving = in_time(probe, from_moving.proven);
    add_to(certificate.undecided, from_moving.left);
    least_m = std::min(least_m, least_of(certificate.from_moving));
  }
  certificate.verdict = verdict_of(certificate);
  const bool is_whole =
      certificate.conflicts.empty() && certificate.undecided.empty() && report.unobserved.empty();
  certificate.certified_clearance_m = is_whole ? least_m : 0.0;
  return certificate;
}

}  // namespace roadbed::planning::audit
