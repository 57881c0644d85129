#include "roadbed/planning/audit/check/certificate_check.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <string_view>
#include <utility>

#include "roadbed/planning/audit/check/brute_force_movers.h"
#include "roadbed/planning/audit/check/brute_force_obstacles.h"

namespace roadbed::planning::inline audit {
namespace {

constexpr double kSlack_m = 1e-6;
constexpr double kSameTime_s = 1e-9;
constexpr double kSameFraction = 2e-3;  // columns over a ground are measured in thousandths
constexpr std::size_t kMostFaults = 10;

struct DriveSample {
  double t_s, x_m, y_m, heading_rad;
};

/// Times that are left out of proofs.
class Times {
 public:
  explicit Times(std::vector<Stretch> stretches) {
    std::ranges::sort(stretches, {}, &Stretch::from_s);
    for (const Stretch& next : stretches) {
      if (next.to_s < next.from_s) continue;
      if (apart_.empty() || next.from_s > apart_.back().to_s + kSameTime_s) {
        apart_.push_back(next);
      } else {
        apart_.back().to_s = std::max(apart_.back().to_s, next.to_s);
      }
    }
  }

  /// Whether they cover a time without a hole.
  bool hold(double from_s, double to_s) const {
    const auto after = std::ranges::upper_bound(apart_, from_s + kSameTime_s, {}, &Stretch::from_s);
    return after != apart_.begin() && std::prev(after)->to_s >= to_s - kSameTime_s;
  }

 private:
  std::vector<Stretch> apart_;
};

class Check {
 public:
  Check(const AuditCertificate& certificate, const std::vector<map::OccupancyCell>& cells,
        double resolution_m, const geometry::Trajectory& drive,
        std::span<const ObstacleInSource> moving)
      : certificate_(certificate),
        movers_(moving),
        body_(certificate.part, certificate.inflate_m),
        part_(certificate.part, 0.0) {
    for (const auto& point : drive.points()) {
      samples_.push_back({point.t_s, point.x_m, point.y_m, point.heading_rad});
    }
    if (samples_.size() == 1) samples_.push_back(samples_.front());
    reach_m_ = body_.reach_m();
    obstacles_.emplace(cells, resolution_m, certificate.band, body_);
  }

  std::vector<std::string> run() {
    mark_columns();
    check_verdict();
    for (const auto* stretches : {&certificate_.unknown, &certificate_.undecided}) {
      for (const Stretch& stretch : *stretches) check_time(stretch);
    }
    std::vector<Stretch> left_out = certificate_.undecided;
    for (const Conflict& conflict : certificate_.conflicts) {
      check_conflict(conflict);
      left_out.push_back({conflict.from_s, conflict.to_s});
    }
    const Times unproven(left_out), unknown(certificate_.unknown);
    check_cover("from_occupied", certificate_.from_occupied, unproven);
    check_distances("from_occupied", certificate_.from_occupied, false);
    if (certificate_.unknown_policy != UnknownPolicy::free) {
      const bool is_obstacle = certificate_.unknown_policy == UnknownPolicy::occupied;
      check_cover("from_unknown", certificate_.from_unknown, is_obstacle ? unproven : unknown);
      check_distances("from_unknown", certificate_.from_unknown, true);
    }
    if (!movers_.empty()) check_moving(unproven);
    check_observed(unknown);
    check_measured_fraction();
    check_certified();
    return std::move(faults_);
  }

 private:
  void fault(std::string text) {
    if (faults_.size() < kMostFaults) faults_.push_back(std::move(text));
  }

  DriveSample at(std::size_t segment, double fraction) const {
    const DriveSample &a = samples_[segment], &b = samples_[segment + 1];
    const auto mix = [fraction](double from, double to) { return from + fraction * (to - from); };
    return {mix(a.t_s, b.t_s), mix(a.x_m, b.x_m), mix(a.y_m, b.y_m),
            mix(a.heading_rad, b.heading_rad)};
  }

  std::size_t segment_at(double t_s) const {
    const auto after =
        std::upper_bound(samples_.begin() + 1, samples_.end() - 1, t_s,
                         [](double t, const DriveSample& sample) { return t < sample.t_s; });
    return static_cast<std::size_t>(after - samples_.begin()) - 1;
  }

  DriveSample at_time(double t_s) const {
    const std::size_t segment = segment_at(t_s);
    const double whole_s = samples_[segment + 1].t_s - samples_[segment].t_s;
    return at(segment, whole_s > 0.0 ? (t_s - samples_[segment].t_s) / whole_s : 0.0);
  }

  double limit_of(const Conflict& conflict) const {
    return std::max(certificate_.clearance_m, conflict.least_clearance_m) + 1.0;
  }

  bool is_in_drive(double t_s) const {
    return samples_.front().t_s - kSameTime_s <= t_s && t_s <= samples_.back().t_s + kSameTime_s;
  }

  void check_time(const Stretch& stretch) {
    if (is_in_drive(stretch.from_s) && is_in_drive(stretch.to_s)) return;
    fault(fmt::format("{:.3f} s to {:.3f} s is not in the drive", stretch.from_s, stretch.to_s));
  }

  // No point of the body moves further from where it is at the span's middle.
  double motion_m(const ProvenSpan& span) const {
    const DriveSample &a = samples_[span.segment], &b = samples_[span.segment + 1];
    const double whole_m = std::hypot(b.x_m - a.x_m, b.y_m - a.y_m) +
                           reach_m_ * std::abs(b.heading_rad - a.heading_rad);
    return 0.5 * (span.to - span.from) * whole_m;
  }

  void check_verdict() {
    Verdict verdict = Verdict::clear;
    if (!certificate_.undecided.empty()) verdict = Verdict::undecided;
    if (!certificate_.unknown.empty()) verdict = Verdict::unknown;
    if (!certificate_.conflicts.empty()) verdict = Verdict::conflict;
    if (verdict != certificate_.verdict) {
      fault(fmt::format("the verdict is \"{}\", its stretches say \"{}\"",
                        to_string(certificate_.verdict), to_string(verdict)));
    }
  }

  // A conflict is one if the body is too near at the state given; where that lies is the drive's.
  void check_conflict(const Conflict& conflict) {
    const double t_s = conflict.at.t_s;
    const auto what = fmt::format("conflict at {:.3f} s", t_s);
    if (!(conflict.from_s <= t_s && t_s <= conflict.to_s)) {
      return fault(what + ": lies outside its own time");
    }
    check_time({conflict.from_s, conflict.to_s});
    if (!conflict.obstacle.empty()) return check_moving_conflict(conflict, what);
    const DriveSample sample = at_time(t_s);
    const double limit_m = limit_of(conflict);
    double distance_m = obstacles_->occupied_m(sample.x_m, sample.y_m, sample.heading_rad, limit_m);
    bool is_witness = obstacles_->is_occupied(conflict.witness);
    if (certificate_.unknown_policy == UnknownPolicy::occupied) {
      distance_m = std::min(
          distance_m, obstacles_->unknown_m(sample.x_m, sample.y_m, sample.heading_rad, limit_m));
      is_witness = is_witness || obstacles_->is_unknown(conflict.witness);
    }
    const double witness_m =
        obstacles_->to_box_m(sample.x_m, sample.y_m, sample.heading_rad, conflict.witness);
    if (!is_witness || std::abs(witness_m - distance_m) > kSlack_m) {
      fault(what + ": the witness is not the nearest obstacle");
    }
    if (std::abs(distance_m - conflict.least_clearance_m) > kSlack_m) {
      fault(what + fmt::format(": the clearance is {:.6f} m, not {:.6f} m", distance_m,
                               conflict.least_clearance_m));
    }
    if (distance_m > 0.0 && distance_m >= certificate_.clearance_m + kSlack_m) {
      fault(what + fmt::format(": {:.6f} m is enough", distance_m));
    }
  }

  void check_moving_conflict(const Conflict& conflict, const std::string& what) {
    const DriveSample sample = at_time(conflict.at.t_s);
    const auto distance_m = movers_.distance_m(
        conflict.obstacle, sample.t_s, body_.at(sample.x_m, sample.y_m, sample.heading_rad));
    if (!distance_m) return fault(what + ": there is no obstacle " + conflict.obstacle);
    if (std::abs(*distance_m - conflict.least_clearance_m) > kSlack_m) {
      fault(what + fmt::format(": the clearance is {:.6f} m, not {:.6f} m", *distance_m,
                               conflict.least_clearance_m));
    }
    if (*distance_m > 0.0 && *distance_m >= certificate_.clearance_m + kSlack_m) {
      fault(what + fmt::format(": {:.6f} m is enough", *distance_m));
    }
  }

  void check_moving(const Times& unproven) {
    double reached_s = samples_.front().t_s;
    for (const ProvenTime& span : certificate_.from_moving) {
      if (!is_in_drive(span.from_s) || !is_in_drive(span.to_s) || span.to_s < span.from_s ||
          span.from_s < reached_s - kSameTime_s) {
        return fault("from_moving: the spans are out of order, or outside the drive");
      }
      check_moving_gap(reached_s, span.from_s, unproven);
      reached_s = span.to_s;
      check_moving_distance(span);
    }
    check_moving_gap(reached_s, samples_.back().t_s, unproven);
    if (certificate_.from_moving.empty() && samples_.front().t_s == samples_.back().t_s &&
        !unproven.hold(reached_s, reached_s)) {
      fault("from_moving: nothing is said of the drive");
    }
  }

  void check_moving_gap(double from_s, double to_s, const Times& unproven) {
    if (to_s - from_s <= kSameTime_s || unproven.hold(from_s, to_s)) return;
    fault(fmt::format("from_moving: nothing is said of {:.6f} s to {:.6f} s", from_s, to_s));
  }

  void check_moving_distance(const ProvenTime& span) {
    const double middle_s = 0.5 * (span.from_s + span.to_s);
    const DriveSample sample = at_time(middle_s);
    const double motion_m = std::max(way_m(span.from_s, middle_s), way_m(middle_s, span.to_s));
    const double needed_m = span.at_least_m + motion_m;
    const bool has_all =
        is_promised(span.at_least_m) &&
        movers_.keep_away(body_.at(sample.x_m, sample.y_m, sample.heading_rad),
                          {span.from_s, span.to_s, samples_.front().t_s, samples_.back().t_s},
                          needed_m - kSlack_m);
    if (has_all) return;
    fault(
        fmt::format("from_moving: at {:.6f} s an obstacle is nearer than {:.6f} m, of which the "
                    "body may move {:.6f} m",
                    middle_s, needed_m, motion_m));
  }

  // How far a point of the body moves at most between two times.
  double way_m(double from_s, double to_s) const {
    double sum_m = 0.0;
    for (std::size_t i = segment_at(from_s); i + 1 < samples_.size() && samples_[i].t_s < to_s;
         ++i) {
      const DriveSample &a = samples_[i], &b = samples_[i + 1];
      const double common_s = std::min(to_s, b.t_s) - std::max(from_s, a.t_s);
      if (common_s <= 0.0 || b.t_s <= a.t_s) continue;
      sum_m += common_s / (b.t_s - a.t_s) *
               (std::hypot(b.x_m - a.x_m, b.y_m - a.y_m) +
                reach_m_ * std::abs(b.heading_rad - a.heading_rad));
    }
    return sum_m;
  }

  bool is_promised(double at_least_m) const {
    return at_least_m > 0.0 && at_least_m >= certificate_.clearance_m;
  }

  void check_cover(std::string_view list, const std::vector<ProvenSpan>& spans,
                   const Times& unproven) {
    std::size_t segment = 0;
    double fraction = 0.0;
    const auto check_gap = [&](std::size_t to_segment, double to_fraction) {
      const double from_s = at(segment, fraction).t_s, to_s = at(to_segment, to_fraction).t_s;
      if (!unproven.hold(from_s, to_s)) {
        fault(fmt::format("{}: nothing is said of {:.6f} s to {:.6f} s", list, from_s, to_s));
      }
    };
    for (const ProvenSpan& span : spans) {
      if (span.segment + 1 >= samples_.size() || span.segment < segment ||
          (span.segment == segment && span.from < fraction)) {
        return fault(fmt::format("{}: the spans are out of order, or outside the drive", list));
      }
      if (span.segment != segment || span.from != fraction) check_gap(span.segment, span.from);
      segment = span.segment;
      fraction = span.to;
      if (fraction == 1.0 && segment + 2 < samples_.size()) ++segment, fraction = 0.0;
    }
    const bool is_whole = segment + 2 == samples_.size() && fraction == 1.0;
    if (!is_whole) check_gap(samples_.size() - 2, 1.0);
  }

  // Near a measured column from the start to the end of what is said, one after the other.
  void check_observed(const Times& unknown) {
    double reached_s = samples_.front().t_s;
    for (const ObservedTime& time : certificate_.observed) {
      if (!is_in_drive(time.from_s) || !is_in_drive(time.to_s) || time.to_s < time.from_s ||
          time.from_s < reached_s - kSameTime_s) {
        return fault("observed: the times are out of order, or outside the drive");
      }
      check_observed_gap(reached_s, time.from_s, unknown);
      check_column(time);
      reached_s = time.to_s;
    }
    check_observed_gap(reached_s, samples_.back().t_s, unknown);
    if (certificate_.observed.empty() && !unknown.hold(reached_s, reached_s)) {
      fault("observed: nothing is said of the drive");
    }
  }

  void check_observed_gap(double from_s, double to_s, const Times& unknown) {
    if (to_s - from_s <= kSameTime_s) return;
    is_all_observed_ = false;
    if (unknown.hold(from_s, to_s)) return;
    fault(fmt::format("observed: nothing is said of {:.6f} s to {:.6f} s", from_s, to_s));
  }

  void check_column(const ObservedTime& time) {
    const DriveSample sample = at_time(time.from_s);
    const auto column = obstacles_->measured_column(time.column_in_source);
    const double far_m =
        column ? part_.at(sample.x_m, sample.y_m, sample.heading_rad)
                         .distance_m({{column->min_in_source,
                                       {column->max_in_source.x(), column->min_in_source.y()},
                                       column->max_in_source,
                                       {column->min_in_source.x(), column->max_in_source.y()}}}) +
                     way_m(time.from_s, time.to_s)
               : std::numeric_limits<double>::infinity();
    if (far_m <= kObservedWithin_m + kSlack_m) return;
    fault(fmt::format("observed: from {:.6f} s to {:.6f} s the column at ({:.3f}, {:.3f}) {}",
                      time.from_s, time.to_s, time.column_in_source.x(), time.column_in_source.y(),
                      column ? fmt::format("may be {:.6f} m away", far_m) : "was not measured"));
  }

  // At poses half a metre of motion apart, or the more on a long drive.
  std::vector<DriveSample> poses_apart() const {
    constexpr double apart_m = 0.5, most_poses = 20'000.0;
    std::vector<double> way_until_m{0.0};
    for (std::size_t i = 0; i + 1 < samples_.size(); ++i) {
      way_until_m.push_back(way_until_m.back() + motion_m({i, 0.0, 1.0}) * 2.0);
    }
    const double step_m = std::max(apart_m, way_until_m.back() / most_poses);
    std::vector<DriveSample> poses;
    std::size_t segment = 0;
    for (double at_m = 0.0; at_m <= way_until_m.back(); at_m += step_m) {
      while (segment + 2 < samples_.size() && way_until_m[segment + 1] < at_m) ++segment;
      const double whole_m = way_until_m[segment + 1] - way_until_m[segment];
      poses.push_back(at(segment, whole_m > 0.0 ? (at_m - way_until_m[segment]) / whole_m : 0.0));
    }
    return poses;
  }

  void check_measured_fraction() {
    double sum = 0.0;
    const std::vector<DriveSample> poses = poses_apart();
    for (const DriveSample& pose : poses) {
      sum += obstacles_->measured_fraction(pose.x_m, pose.y_m, pose.heading_rad);
    }
    const double fraction = sum / static_cast<double>(poses.size());
    if (std::abs(fraction - certificate_.measured_fraction) <= kSameFraction) return;
    fault(
        fmt::format("measured_share: {:.4f} of the space that the part takes was measured, not "
                    "{:.4f}",
                    fraction, certificate_.measured_fraction));
  }

  void mark_columns() {
    for (const DriveSample& pose : poses_apart()) obstacles_->mark(pose.x_m, pose.y_m, 0.0);
    for (const ObservedTime& time : certificate_.observed) {
      obstacles_->mark(time.column_in_source.x(), time.column_in_source.y(), -reach_m_);
    }
    if (certificate_.unknown_policy == UnknownPolicy::occupied) {
      for (const Conflict& conflict : certificate_.conflicts) {
        const DriveSample sample = at_time(conflict.at.t_s);
        obstacles_->mark(sample.x_m, sample.y_m, limit_of(conflict));
      }
    }
    for (const ProvenSpan& span : certificate_.from_unknown) {
      if (span.segment + 1 >= samples_.size()) continue;
      const DriveSample sample = at(span.segment, 0.5 * (span.from + span.to));
      obstacles_->mark(sample.x_m, sample.y_m, span.at_least_m + motion_m(span) + kSlack_m);
    }
    obstacles_->measure();
  }

  void check_distances(std::string_view list, const std::vector<ProvenSpan>& spans,
                       bool is_unknown) {
    for (const ProvenSpan& span : spans) {
      if (span.segment + 1 >= samples_.size()) continue;
      const DriveSample sample = at(span.segment, 0.5 * (span.from + span.to));
      const double needed_m = span.at_least_m + motion_m(span);
      const double limit_m = needed_m + kSlack_m;
      const double distance_m =
          is_unknown ? obstacles_->unknown_m(sample.x_m, sample.y_m, sample.heading_rad, limit_m)
                     : obstacles_->occupied_m(sample.x_m, sample.y_m, sample.heading_rad, limit_m);
      if (is_promised(span.at_least_m) && distance_m >= needed_m - kSlack_m) continue;
      fault(
          fmt::format("{}: at {:.6f} s the distance is {:.6f} m, and the body may move {:.6f} m: "
                      "that is no {:.6f} m",
                      list, sample.t_s, distance_m, motion_m(span), span.at_least_m));
    }
  }

  void check_certified() {
    const bool is_whole =
        certificate_.conflicts.empty() && certificate_.undecided.empty() && is_all_observed_;
    double least_m = is_whole ? std::numeric_limits<double>::infinity() : 0.0;
    for (const ProvenSpan& span : certificate_.from_occupied) {
      least_m = std::min(least_m, span.at_least_m);
    }
    if (certificate_.unknown_policy == UnknownPolicy::occupied) {
      for (const ProvenSpan& span : certificate_.from_unknown) {
        least_m = std::min(least_m, span.at_least_m);
      }
    }
    for (const ProvenTime& span : certificate_.from_moving) {
      least_m = std::min(least_m, span.at_least_m);
    }
    if (certificate_.certified_clearance_m <= least_m) return;
    fault(fmt::format("the spans certify {:.6f} m, not {:.6f} m", least_m,
                      certificate_.certified_clearance_m));
  }

  const AuditCertificate& certificate_;
  BruteForceMovers movers_;
  BodyOutline body_, part_;  // with the margin, and without it
  std::vector<DriveSample> samples_;
  double reach_m_ = 0.0;
  bool is_all_observed_ = true;
  std::optional<BruteForceObstacles> obstacles_;
  std::vector<std::string> faults_;
};

}  // namespace

std::vector<std::string> check_certificate(const AuditCertificate& certificate,
                                           const std::vector<map::OccupancyCell>& cells,
                                           double resolution_m,
                                           const geometry::Trajectory& drive_in_source,
                                           std::span<const ObstacleInSource> moving_in_source) {
  return Check(certificate, cells, resolution_m, drive_in_source, moving_in_source).run();
}

double checked_distance_m(const AuditCertificate& certificate,
                          const geometry::Trajectory& drive_in_source) {
  const double reach_m = BodyOutline(certificate.part, certificate.inflate_m).reach_m();
  double most_m = certificate.clearance_m;
  for (const auto* spans : {&certificate.from_occupied, &certificate.from_unknown}) {
    for (const ProvenSpan& span : *spans) most_m = std::max(most_m, span.at_least_m);
  }
  for (const Conflict& conflict : certificate.conflicts) {
    most_m = std::max(most_m, conflict.least_clearance_m);
  }
  double motion_m = 0.0;
  const auto& samples = drive_in_source.points();
  for (std::size_t i = 1; i < samples.size(); ++i) {
    motion_m = std::max(
        motion_m,
        std::hypot(samples[i].x_m - samples[i - 1].x_m, samples[i].y_m - samples[i - 1].y_m) +
            reach_m * std::abs(samples[i].heading_rad - samples[i - 1].heading_rad));
  }
  constexpr double beyond_m = 2.0;  // how far distances are measured over what is asked for
  return most_m + motion_m + reach_m + beyond_m;
}

}  // namespace roadbed::planning::audit
