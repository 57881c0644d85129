#include "roadbed/planning/audit/certificate.h"

#include <algorithm>
#include <limits>
#include <optional>
#include <utility>

#include "roadbed/planning/audit/body_probe.h"
#include "roadbed/planning/audit/moving_probe.h"

namespace roadbed::planning::inline audit {
namespace {

using map::ObstacleKind;

constexpr double kMostCertified_m = 5.0;  // more room than this would only make more spans
constexpr double kMostOver_m = 1.0;       // the same, of what a span promises over its goal
constexpr double kLeastMotion_m = 1e-7;   // motion bound of a span that is not halved any more

/// Proven spans, and the stretches that could not be proven.
struct Cover {
  std::vector<ProvenSpan> proven;
  std::vector<Stretch> left;
};

class Prover {
 public:
  Prover(const ClearanceProbe& probe, double goal_m, const std::vector<Stretch>& left_out)
      : probe_(probe), goal_m_(goal_m), left_out_(left_out) {}

  Cover run() {
    for (std::size_t segment = 0; segment < probe_.segments();) {
      spare_m_ = -1.0;
      cover(segment);
      segment = cover_settled(segment, probe_.next_after(segment, spare_m_));
    }
    return std::move(cover_);
  }

 private:
  void cover(std::size_t segment) {
    to_come_.assign({{segment, 0.0, 1.0}});
    while (!to_come_.empty()) {
      const Span span = to_come_.back();
      to_come_.pop_back();
      if (settle(span)) continue;
      to_come_.push_back(span.second_half());
      to_come_.push_back(span.first_half());
    }
  }

  // Spans of the segments that are settled with another one, up to `next`.
  std::size_t cover_settled(std::size_t segment, std::size_t next) {
    for (++segment; segment < next; ++segment) {
      const Span span{segment, 0.0, 1.0};
      spare_m_ -= 2.0 * probe_.motion_bound_m(span);
      prove(span, goal_m_ + std::max(spare_m_, 0.0) + kOver_m);
    }
    return next;
  }

  Stretch time_of(const Span& span) const {
    return {probe_.time_at(span.segment, span.from), probe_.time_at(span.segment, span.to)};
  }

  bool is_left_out(const Stretch& time) {
    while (next_ < left_out_.size() && left_out_[next_].to_s < time.from_s) ++next_;
    for (std::size_t i = next_; i < left_out_.size() && left_out_[i].from_s <= time.from_s; ++i) {
      if (time.to_s <= left_out_[i].to_s) return true;
    }
    return false;
  }

  bool settle(const Span& span) {
    const Stretch time = time_of(span);
    if (is_left_out(time)) return true;
    const double motion_m = probe_.motion_bound_m(span);
    const double bound_m = probe_.lower_bound_m(span, goal_m_ + motion_m + kOver_m) - motion_m;
    if (prove(span, bound_m)) {
      if (span.to - span.from == 1.0) spare_m_ = bound_m - goal_m_ - kOver_m;
      return true;
    }
    const double within_m = std::min(goal_m_ + 2.0 * motion_m, probe_.horizon_m());
    const auto nearest = probe_.nearest(span, within_m);
    if (prove(span, (nearest ? nearest->distance_m : within_m) - motion_m)) return true;
    if (motion_m > kLeastMotion_m) return false;
    cover_.left.push_back(time);
    return true;
  }

  bool prove(const Span& span, double at_least_m) {
    if (!(at_least_m > 0.0 && at_least_m >= goal_m_)) return false;
    cover_.proven.push_back(
        {span.segment, span.from, span.to, std::min(at_least_m, goal_m_ + kMostOver_m)});
    return true;
  }

  const ClearanceProbe& probe_;
  double goal_m_;
  const std::vector<Stretch>& left_out_;  // in order of time
  std::size_t next_ = 0;
  double spare_m_ = 0.0;  // of the segment that is being covered, where one span does
  std::vector<Span> to_come_;
  Cover cover_;
};

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
    return Prover(probe, goal_m, left_out).run();
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

  Cover from_occupied = cover(ObstacleKind::occupied, goal_m, left_out);
  certificate.from_occupied = std::move(from_occupied.proven);
  add_to(certificate.undecided, from_occupied.left);
  double least_m = least_of(certificate.from_occupied);
  if (options.unknown == UnknownPolicy::occupied) {
    Cover from_unknown = cover(ObstacleKind::unknown, goal_m, left_out);
    certificate.from_unknown = std::move(from_unknown.proven);
    add_to(certificate.undecided, from_unknown.left);
    least_m = std::min(least_m, least_of(certificate.from_unknown));
  } else if (options.unknown == UnknownPolicy::report) {
    Cover from_unknown = cover(ObstacleKind::unknown, options.clearance_m, report.unknown);
    certificate.from_unknown = std::move(from_unknown.proven);
    add_to(certificate.unknown, from_unknown.left);
  }
  if (!moving_in_source.empty()) {
    const geometry::Trajectory drive = with_samples_at_changes(drive_in_source, moving_in_source);
    const MovingProbe probe(drive, body, moving_in_source, field.horizon_m());
    const Cover from_moving = Prover(probe, goal_m, left_out).run();
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
