#include "roadbed/planning/audit.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>
#include <utility>

#include "roadbed/planning/body_probe.h"
#include "roadbed/planning/body_side.h"
#include "roadbed/planning/least_clearance.h"
#include "roadbed/planning/moving_probe.h"
#include "roadbed/planning/near_stretches.h"
#include "roadbed/planning/prediction.h"

namespace roadbed::planning {
namespace {

using map::ObstacleKind;

void check(const map::ClearanceField& field, const geometry::Trajectory& drive,
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
  const double radius_m = geometry::inflated(part, options.inflate_m).radius_m;
  const double seen_m = field.horizon_m() - radius_m;
  if (!(seen_m > 0.0)) refuse("the circle's radius", radius_m);
  if (!(options.clearance_m < 0.5 * seen_m)) refuse("clearance_m", options.clearance_m);
  if (!(options.tolerance_m >= 1e-4)) refuse("tolerance_m", options.tolerance_m);
}

std::vector<ObstacleKind> obstacles(UnknownPolicy policy) {
  if (policy == UnknownPolicy::occupied) return {ObstacleKind::occupied, ObstacleKind::unknown};
  return {ObstacleKind::occupied};
}

// Poses half a metre of motion apart, and at least one for each stand.
double mean_unknown_share(const map::ClearanceField& field, const Probe& probe,
                          const geometry::BodyPart& body) {
  constexpr double least_apart_m = 0.5, most_poses = 20'000;
  const std::vector<double>& moved_m = probe.moved_m();
  const double apart_m = std::max(least_apart_m, moved_m.back() / most_poses);
  const auto poses = 1 + static_cast<std::size_t>(moved_m.back() / apart_m);
  double sum = 0.0;
  std::size_t segment = 0;
  for (std::size_t i = 0; i < poses; ++i) {
    const double at_m = apart_m * static_cast<double>(i);
    while (segment + 1 < probe.segments() && moved_m[segment + 1] < at_m) ++segment;
    const double share = (at_m - moved_m[segment]) / (moved_m[segment + 1] - moved_m[segment]);
    sum += field.unknown_share(body.box_at(probe.state_at(segment, std::min(share, 1.0)).pose()));
  }
  return sum / static_cast<double>(poses);
}

// A row is the start of its segment; the last one the end of the last.
Span at_row(const Probe& probe, std::size_t row) {
  if (row < probe.segments()) return {row, 0.0, 0.0};
  return {probe.segments() - 1, 1.0, 1.0};
}

std::vector<AuditReport::Sample> clearance_at_rows(const Probe& probe,
                                                   const geometry::Trajectory& drive) {
  constexpr double exact_below_m = 5.0;
  constexpr std::size_t most_samples = 5000;
  std::vector<AuditReport::Sample> profile;
  const auto& rows = drive.points();
  const std::size_t step = 1 + rows.size() / most_samples;
  for (std::size_t i = 0; i < rows.size(); i += step) {
    const Span row = at_row(probe, i);
    double clearance_m = probe.lower_bound_m(row, exact_below_m);
    if (clearance_m < exact_below_m) {
      const auto nearest = probe.nearest(row, exact_below_m);
      clearance_m = nearest ? nearest->distance_m : std::min(exact_below_m, probe.horizon_m());
    }
    profile.push_back({rows[i].t_s, clearance_m});
  }
  return profile;
}

// Times that cannot be proven to be over measured space count as unknown.
std::vector<Stretch> near_unknown(const map::ClearanceField& field,
                                  const geometry::Trajectory& drive, const geometry::BodyPart& body,
                                  const AuditOptions& options) {
  const BodyProbe probe(field, drive, body, {ObstacleKind::unknown});
  const NearStretches found = find_near_stretches(probe, options.clearance_m, options.tolerance_m);
  std::vector<Stretch> stretches = found.undecided;
  for (const Conflict& near : found.near) stretches.push_back({near.from_s, near.to_s});
  std::sort(stretches.begin(), stretches.end(),
            [](const Stretch& a, const Stretch& b) { return a.from_s < b.from_s; });
  return stretches;
}

geometry::Rectangle thing_at(double t_s, const map::Box2& witness, const std::string& id,
                             std::span<const MovingObstacle> moving) {
  for (const MovingObstacle& mover : moving) {
    if (id.empty() || mover.obstacle.id != id) continue;
    const geometry::Pose2 centre = mover.obstacle.motion.at(t_s).pose();
    return body_around(centre, mover.obstacle.length_m, mover.obstacle.width_m);
  }
  const Eigen::Vector2d half = 0.5 * (witness.max_in_source - witness.min_in_source);
  return {.centre = 0.5 * (witness.min_in_source + witness.max_in_source),
          .half_length_m = half.x(),
          .half_width_m = half.y()};
}

std::string part_of(const geometry::TrajectoryPoint& at, const map::Box2& witness,
                    const std::string& id, std::span<const MovingObstacle> moving,
                    const geometry::BodyPart& body) {
  if (body.is_circle()) return body.name;
  return std::string(side_towards(thing_at(at.t_s, witness, id, moving), body.core_at(at.pose())));
}

/// What is asked of both kinds of obstacles, and the answer for both.
class Auditor {
 public:
  Auditor(const AuditOptions& options, const geometry::Trajectory& drive, AuditReport& report)
      : options_(options), drive_(drive), report_(report) {}

  void ask(const Probe& probe) {
    const LeastClearance least = find_least_clearance(probe, options_.tolerance_m);
    if (!is_asked_ || least.found_m < report_.least_clearance_m) {
      report_.least_clearance_m = least.found_m;
      report_.least_clearance_at_s = least.at.t_s;
      report_.witness = least.witness;
      report_.obstacle = least.obstacle;
    }
    report_.proven_clearance_m =
        is_asked_ ? std::min(report_.proven_clearance_m, least.proven_m) : least.proven_m;
    if (least.proven_m <= 0.0 || least.proven_m < options_.clearance_m) add_conflicts(probe);
    add_profile(clearance_at_rows(probe, drive_));
    is_asked_ = true;
  }

 private:
  void add_conflicts(const Probe& probe) {
    const NearStretches found =
        find_near_stretches(probe, options_.clearance_m, options_.tolerance_m);
    const auto add = [](auto& to, const auto& more) {
      to.insert(to.end(), more.begin(), more.end());
      std::ranges::stable_sort(to, {}, [](const auto& stretch) { return stretch.from_s; });
    };
    add(report_.conflicts, found.near);
    add(report_.undecided, found.undecided);
  }

  void add_profile(std::vector<AuditReport::Sample> samples) {
    if (!is_asked_) {
      report_.profile = std::move(samples);
      return;
    }
    for (std::size_t i = 0; i < samples.size(); ++i) {
      report_.profile[i].clearance_m =
          std::min(report_.profile[i].clearance_m, samples[i].clearance_m);
    }
  }

  const AuditOptions& options_;
  const geometry::Trajectory& drive_;
  AuditReport& report_;
  bool is_asked_ = false;
};

}  // namespace

std::string_view name(UnknownPolicy policy) {
  constexpr std::array<std::string_view, 3> names{"free", "occupied", "report"};
  return names[static_cast<std::size_t>(policy)];
}

std::string_view name(Verdict verdict) {
  constexpr std::array<std::string_view, 4> names{"clear", "conflict", "unknown", "undecided"};
  return names[static_cast<std::size_t>(verdict)];
}

Verdict judge(const AuditReport& report) {
  if (!report.conflicts.empty()) return Verdict::conflict;
  if (!report.unknown.empty()) return Verdict::unknown;
  return report.undecided.empty() ? Verdict::clear : Verdict::undecided;
}

map::FieldRegion audited_region(const geometry::Trajectory& drive_in_source,
                                std::span<const geometry::BodyPart> parts,
                                const AuditOptions& options) {
  constexpr double least_horizon_m = 50.0;
  double farthest_m = 0.0, radius_m = 0.0, circle_m = 0.0;
  for (const geometry::BodyPart& part : parts) {
    const geometry::BodyPart body = geometry::inflated(part, options.inflate_m);
    // The box around a circle, which unknown space is shared out in, reaches beyond it.
    const double box_m = std::sqrt(2.0) * body.radius_m;
    farthest_m = std::max({farthest_m, body.reach_m(), body.middle_in_vehicle().norm() + box_m});
    circle_m = std::max(circle_m, body.radius_m);
    radius_m = std::max(radius_m, std::sqrt(2.0) * body.circumradius_m());  // of the box around it
  }
  const Eigen::Vector2d reach_m = Eigen::Vector2d::Constant(farthest_m);
  const Eigen::Vector2d start = drive_in_source.points().front().pose().position();
  map::Box2 around{start, start};
  for (const geometry::TrajectoryPoint& point : drive_in_source.points()) {
    around.min_in_source = around.min_in_source.cwiseMin(point.pose().position());
    around.max_in_source = around.max_in_source.cwiseMax(point.pose().position());
  }
  around.min_in_source -= reach_m;
  around.max_in_source += reach_m;
  return {.around = around,
          .horizon_m = std::max(least_horizon_m, 3.0 * options.clearance_m) + circle_m,
          .body_radius_m = radius_m};
}

AuditReport audit(const map::ClearanceField& field, const geometry::Trajectory& drive_in_source,
                  const geometry::BodyPart& part, const AuditOptions& options,
                  std::span<const MovingObstacle> moving_in_source) {
  check(field, drive_in_source, part, options);
  const geometry::BodyPart body = geometry::inflated(part, options.inflate_m);
  std::optional<geometry::Trajectory> with_changes;
  if (!moving_in_source.empty()) {
    with_changes = with_rows_at_changes(drive_in_source, moving_in_source);
  }
  const geometry::Trajectory& drive = with_changes ? *with_changes : drive_in_source;
  const BodyProbe probe(field, drive, body, obstacles(options.unknown));

  AuditReport report;
  Auditor auditor(options, drive, report);
  auditor.ask(probe);
  if (with_changes) {
    auditor.ask(MovingProbe(drive, body, moving_in_source, field.horizon_m()));
  }
  report.beyond_horizon = !report.witness;
  if (report.witness) {
    report.part = part_of(drive.at(report.least_clearance_at_s), *report.witness, report.obstacle,
                          moving_in_source, body);
  }
  for (Conflict& conflict : report.conflicts) {
    conflict.part =
        part_of(conflict.at, conflict.witness, conflict.obstacle, moving_in_source, body);
  }
  if (options.unknown == UnknownPolicy::report) {
    report.unknown = near_unknown(field, drive, body, options);
  }
  report.unknown_share = mean_unknown_share(field, probe, body);
  report.verdict = judge(report);
  return report;
}

}  // namespace roadbed::planning
