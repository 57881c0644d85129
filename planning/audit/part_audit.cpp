#include "roadbed/planning/audit/part_audit.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "roadbed/geometry/motion/rectangle.h"
#include "roadbed/planning/audit/body_probe.h"
#include "roadbed/planning/audit/deepest_overlap.h"
#include "roadbed/planning/audit/least_clearance.h"
#include "roadbed/planning/audit/moving_probe.h"
#include "roadbed/planning/audit/near_stretches.h"
#include "roadbed/planning/audit/observed_space.h"

namespace roadbed::planning::inline audit {
namespace {

using map::ObstacleKind;

// Of a drive that is looked at together: about a tile of a field.
constexpr std::size_t kMostSegments = 1024;
constexpr double kStretch_m = 100.0;

std::size_t seeds_apart(std::size_t segments) { return 1 + segments / 64; }

// @returns the part, inflated.
geometry::BodyPart checked(const map::ClearanceField& field, const geometry::Trajectory& drive,
                           const geometry::BodyPart& part, const AuditOptions& options) {
  part.check();
  if (drive.empty()) throw std::invalid_argument("audit: the drive needs at least 1 point, got 0");
  const auto refuse = [](const char* option, double value) {
    throw std::invalid_argument(fmt::format("audit: {} is out of range, got {} m", option, value));
  };
  const auto is_length = [](double value) { return value >= 0.0 && std::isfinite(value); };
  if (!is_length(options.clearance_m)) refuse("clearance_m", options.clearance_m);
  if (!is_length(options.inflate_m)) refuse("inflate_m", options.inflate_m);
  // A circle is looked at from its middle.
  const geometry::BodyPart body = geometry::inflated(part, options.inflate_m);
  const double seen_m = field.horizon_m() - body.radius_m;
  if (!(seen_m > 0.0)) refuse("the circle's radius", body.radius_m);
  if (!(options.clearance_m < 0.5 * seen_m)) refuse("clearance_m", options.clearance_m);
  if (!(options.tolerance_m >= 1e-4)) refuse("tolerance_m", options.tolerance_m);
  if (!(options.least_measured >= 0.0 && options.least_measured <= 1.0)) {
    throw std::invalid_argument(
        fmt::format("audit: least_measured is no fraction, got {}", options.least_measured));
  }
  return body;
}

std::vector<ObstacleKind> obstacles(UnknownPolicy policy) {
  if (policy == UnknownPolicy::occupied) return {ObstacleKind::occupied, ObstacleKind::unknown};
  return {ObstacleKind::occupied};
}

// A sample is the start of its segment; the last one the end of the last.
Span at_sample(const ClearanceProbe& probe, std::size_t sample) {
  if (sample < probe.segments()) return {sample, 0.0, 0.0};
  return {probe.segments() - 1, 1.0, 1.0};
}

std::size_t samples_apart(const geometry::Trajectory& drive) {
  constexpr std::size_t most_samples = 5000;
  return 1 + drive.points().size() / most_samples;
}

std::size_t stretch_end(const std::vector<double>& moved_m, std::size_t from) {
  const auto first = moved_m.begin() + static_cast<std::ptrdiff_t>(from) + 1;
  const auto most = moved_m.begin() +
                    static_cast<std::ptrdiff_t>(std::min(from + kMostSegments, moved_m.size() - 1));
  const auto end = std::lower_bound(first, most, moved_m[from] + kStretch_m);
  return static_cast<std::size_t>(end - moved_m.begin());
}

double clearance_at(const ClearanceProbe& probe, std::size_t sample) {
  constexpr double exact_below_m = 5.0;
  const Span at = at_sample(probe, sample);
  const double bound_m = probe.lower_bound_m(at, exact_below_m);
  if (bound_m >= exact_below_m) return bound_m;
  const auto nearest = probe.nearest(at, exact_below_m);
  return nearest ? nearest->distance_m : std::min(exact_below_m, probe.horizon_m());
}

// Poses half a metre of motion apart, or farther on a long drive.
double poses_apart_m(const ClearanceProbe& probe) {
  constexpr double least_apart_m = 0.5, most_poses = 20'000;
  return std::max(least_apart_m, probe.moved_m().back() / most_poses);
}

// Times that cannot be proven to be over measured space count as unknown.
std::vector<Stretch> unknown_times(const NearStretches& found) {
  std::vector<Stretch> stretches = found.undecided;
  for (const Conflict& near : found.near) stretches.push_back({near.from_s, near.to_s});
  std::ranges::sort(stretches, {}, &Stretch::from_s);
  return stretches;
}

geometry::Rectangle thing_at(double t_s, const map::Box2& witness, const std::string& id,
                             std::span<const ObstacleInSource> moving) {
  if (const ObstacleInSource* mover = find_mover(moving, id)) return rectangle_at(*mover, t_s);
  const Eigen::Vector2d half = 0.5 * (witness.max_in_source - witness.min_in_source);
  return {.centre = 0.5 * (witness.min_in_source + witness.max_in_source),
          .half_length_m = half.x(),
          .half_width_m = half.y()};
}

std::string part_of(const geometry::TrajectoryPoint& at, const map::Box2& witness,
                    const std::string& id, std::span<const ObstacleInSource> moving,
                    const geometry::BodyPart& body) {
  if (body.is_circle()) return body.name;
  return std::string(side_towards(thing_at(at.t_s, witness, id, moving), body.core_at(at.pose())));
}

/// The audit of one part of a vehicle, stretch by stretch along the drive.
class PartAudit {
 public:
  /// What is given has to outlive it.
  PartAudit(const map::ClearanceField& field, const geometry::Trajectory& drive_in_source,
            const geometry::BodyPart& part, const AuditOptions& options,
            std::span<const ObstacleInSource> moving_in_source);
  PartAudit(const PartAudit&) = delete;
  PartAudit& operator=(const PartAudit&) = delete;

  void seed(std::size_t segment) { least_.seed(segment); }
  void advance(std::size_t from, std::size_t to);

  /// @pre it has advanced to the end of the drive
  AuditReport report() &&;

  const BodyProbe& probe() const { return probe_; }

 private:
  void take_samples(std::size_t to);
  void take_unknown_fractions(std::size_t to);
  void take_least(const LeastClearance& least);
  bool is_near(const LeastClearance& least) const;
  void collect_conflicts(const ClearanceProbe& probe);
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

PartAudit::PartAudit(const map::ClearanceField& field, const geometry::Trajectory& drive_in_source,
                     const geometry::BodyPart& part, const AuditOptions& options,
                     std::span<const ObstacleInSource> moving_in_source)
    : field_(field),
      options_(options),
      moving_(moving_in_source),
      part_(part),
      body_(checked(field, drive_in_source, part, options)),
      drive_(drive_in_source),
      probe_(field, drive_, body_, obstacles(options.unknown)),
      least_(probe_, options.tolerance_m),
      observed_(field, probe_, part_) {
  if (options.unknown != UnknownPolicy::report) return;
  unknown_probe_.emplace(field, drive_, body_, std::vector{ObstacleKind::unknown});
  unknown_.emplace(*unknown_probe_, options.clearance_m, options.tolerance_m);
}

void PartAudit::advance(std::size_t from, std::size_t to) {
  least_.search(from, to);
  if (unknown_) unknown_->search(to);
  observed_.search(to);
  take_samples(to);
  take_unknown_fractions(to);
}

void PartAudit::take_samples(std::size_t to) {
  const auto& samples = drive_.points();
  const std::size_t end = to == probe_.segments() ? samples.size() : to,
                    apart = samples_apart(drive_);
  for (std::size_t sample = apart * report_.profile.size(); sample < end; sample += apart) {
    report_.profile.push_back({samples[sample].t_s, clearance_at(probe_, sample)});
  }
}

void PartAudit::take_unknown_fractions(std::size_t to) {
  const std::vector<double>& moved_m = probe_.moved_m();
  const double apart_m = poses_apart_m(probe_);
  for (;; ++poses_) {
    const double at_m = apart_m * static_cast<double>(poses_);
    if (at_m > moved_m[to]) return;
    const auto [segment, fraction] = probe_.place_moved(at_m);
    unknown_sum_ +=
        field_.unknown_fraction(body_.box_at(probe_.state_at(segment, fraction).pose()));
  }
}

void PartAudit::take_least(const LeastClearance& least) {
  report_.least_clearance_m = least.found_m;
  report_.least_clearance_at_s = least.at.t_s;
  report_.witness = least.witness;
  report_.obstacle = least.obstacle;
}

// A proof span by span, as a certificate has, does not tell distances nearer to the limit apart.
bool PartAudit::is_near(const LeastClearance& least) const {
  return least.proven_m < options_.clearance_m + kLeastTold_m;
}

void PartAudit::collect_conflicts(const ClearanceProbe& probe) {
  NearStretchSearch search(probe, options_.clearance_m, options_.tolerance_m);
  search.search(probe.segments());
  const NearStretches found = search.found();
  const auto add = [](auto& to, const auto& more) {
    to.insert(to.end(), more.begin(), more.end());
    std::ranges::stable_sort(to, {}, [](const auto& stretch) { return stretch.from_s; });
  };
  add(report_.conflicts, found.near);
  add(report_.undecided, found.undecided);
}

void PartAudit::audit_moving() {
  const MovingProbe probe(drive_, body_, moving_, field_.horizon_m());
  LeastClearanceSearch search(probe, options_.tolerance_m);
  for (std::size_t segment = 0; segment < probe.segments();
       segment += seeds_apart(probe.segments())) {
    search.seed(segment);
  }
  for (std::size_t from = 0; from < probe.segments(); from += kMostSegments) {
    search.search(from, std::min(from + kMostSegments, probe.segments()));
  }
  const LeastClearance least = search.found();
  if (least.found_m < report_.least_clearance_m) take_least(least);
  report_.proven_clearance_m = std::min(report_.proven_clearance_m, least.proven_m);
  if (is_near(least)) collect_conflicts(probe);
  for (std::size_t i = 0; i < report_.profile.size(); ++i) {
    double& clearance_m = report_.profile[i].clearance_m;
    clearance_m = std::min(clearance_m, clearance_at(probe, i * samples_apart(drive_)));
  }
}

void PartAudit::collect_unobserved() {
  report_.observed = observed_.take_observed();
  for (const Stretch& stretch : observed_.unobserved()) {
    report_.unknown.push_back(stretch);
    report_.unobserved.push_back({stretch.from_s, stretch.to_s, part_.name});
  }
  report_.unknown = joined(std::move(report_.unknown));
}

void PartAudit::describe_conflicts() {
  const DeepestOverlapSearch deepest(field_, probe_, body_, obstacles(options_.unknown), moving_,
                                     report_.conflicts.size());
  for (Conflict& conflict : report_.conflicts) {
    conflict.part = part_of(conflict.at, conflict.witness, conflict.obstacle, moving_, body_);
    if (conflict.least_clearance_m == 0.0) conflict.deepest = deepest.of(conflict);
  }
}

AuditReport PartAudit::report() && {
  const LeastClearance least = least_.found();
  take_least(least);
  report_.proven_clearance_m = least.proven_m;
  if (is_near(least)) collect_conflicts(probe_);
  if (!moving_.empty()) audit_moving();
  report_.beyond_horizon = !report_.witness;
  if (report_.witness) {
    report_.part = part_of(drive_.at(report_.least_clearance_at_s), *report_.witness,
                           report_.obstacle, moving_, body_);
  }
  describe_conflicts();
  if (unknown_) report_.unknown = unknown_times(unknown_->found());
  collect_unobserved();
  report_.unknown_fraction = unknown_sum_ / static_cast<double>(poses_);
  report_.least_measured = options_.least_measured;
  report_.verdict = verdict_of(report_);
  return std::move(report_);
}

}  // namespace

std::vector<AuditReport> audit_parts(std::span<const PartInField> parts,
                                     const geometry::Trajectory& drive_in_source,
                                     const AuditOptions& options,
                                     std::span<const ObstacleInSource> moving_in_source) {
  if (parts.empty()) return {};
  std::vector<std::unique_ptr<PartAudit>> audits;
  for (const auto& [field, part] : parts) {
    audits.push_back(
        std::make_unique<PartAudit>(field, drive_in_source, part, options, moving_in_source));
  }
  const std::vector<double>& moved_m = audits.front()->probe().moved_m();
  const std::size_t segments = audits.front()->probe().segments();
  for (std::size_t segment = 0; segment < segments; segment += seeds_apart(segments)) {
    for (const auto& audit : audits) audit->seed(segment);
  }
  for (std::size_t from = 0; from < segments;) {
    const std::size_t to = stretch_end(moved_m, from);
    for (const auto& audit : audits) audit->advance(from, to);
    from = to;
  }
  std::vector<AuditReport> reports;
  for (const auto& audit : audits) reports.push_back(std::move(*audit).report());
  return reports;
}

}  // namespace roadbed::planning::audit
