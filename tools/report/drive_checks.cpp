#include "roadbed/tools/report/from_drive.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <string>

#include "roadbed/tools/report/comfort.h"
#include "roadbed/tools/report/motion_plots.h"

namespace roadbed::tools::inline report {
namespace {

using Row = geometry::TrajectoryPoint;

constexpr double kOverLimitTolerance_mps = 0.5;  // a controller overshoots a little

// The largest value of all rows, and the first time of it.
template <typename Value>
Worst largest(const Drive& drive, Value value) {
  Worst worst{-std::numeric_limits<double>::infinity(), 0.0};
  for (std::size_t i = 0; i < drive.samples.size(); ++i) {
    const double found = value(drive.trajectory.points()[i], drive.samples[i]);
    if (found > worst.value) worst = {found, drive.samples[i].t_s};
  }
  return worst;
}

ReportCheck noted(std::string name, double value, std::string unit, std::optional<double> at_s) {
  return {.name = std::move(name),
          .value = value,
          .unit = std::move(unit),
          .bound = {},
          .passed = true,
          .at_s = at_s};
}

ReportCheck outcome_check(const Drive& drive) {
  return {.name = "goal reached",
          .value = {},
          .unit = {},
          .bound = "required",
          .passed = drive.verdict.outcome == Outcome::goal_reached,
          .at_s = drive.trajectory.empty() ? std::optional<double>() : drive.verdict.at_s,
          .bound_from = "the scenario"};
}

ReportCheck clearance_check(const Drive& drive) {
  const Worst nearest =
      largest(drive, [](const Row&, const DriveSample& s) { return -s.clearance_m; });
  ReportCheck check{.name = "least clearance to obstacles",
                    .value = {},
                    .unit = "m",
                    .bound = "> 0",
                    .passed = nearest.value < 0.0,
                    .at_s = {},
                    .bound_from = "nothing is touched"};
  if (std::isfinite(nearest.value)) {
    check.value = -nearest.value;
    check.at_s = nearest.at_s;
  }
  return check;
}

ReportCheck audit_check(const planning::AuditReport& audit) {
  return {.name = audit.beyond_horizon ? "clearance to occupied space, at least"
                                       : "least clearance to occupied space",
          .value = audit.least_clearance_m,
          .unit = "m",
          .bound = "no conflict",
          .passed = audit.verdict != planning::Verdict::conflict,
          .at_s = audit.least_clearance_at_s,
          .bound_from = "the audit"};
}

void append_motion_checks(const Drive& drive, std::vector<ReportCheck>& checks) {
  const auto off_road = [](const Row&, const DriveSample& s) { return s.off_road_m; };
  const auto over_limit = [](const Row& p, const DriveSample& s) {
    return p.speed_mps - s.speed_limit_mps;
  };
  checks.push_back(
      at_most("farthest off the road", largest(drive, off_road), 0.0, "m", "the map's surface"));
  checks.push_back(at_most("speed above the limit", largest(drive, over_limit),
                           kOverLimitTolerance_mps, "m/s", "the map's limit, overshoot"));
  std::ranges::move(comfort_checks(drive.trajectory), std::back_inserter(checks));
}

void append_notes(const Drive& drive, std::vector<ReportCheck>& checks) {
  const Worst cross_track =
      largest(drive, [](const Row&, const DriveSample& s) { return std::abs(s.cross_track_m); });
  const Worst heading = largest(
      drive, [](const Row&, const DriveSample& s) { return std::abs(s.heading_error_rad); });
  const auto blind = std::ranges::count_if(
      drive.cycles, [](const DriveCycle& cycle) { return !cycle.has_plan(); });
  checks.push_back(noted("largest cross-track error", cross_track.value, "m", cross_track.at_s));
  checks.push_back(noted("largest heading error", heading.value, "rad", heading.at_s));
  checks.push_back(noted("cruise control saturated", 100.0 * drive.saturated_ratio, "%", {}));
  checks.push_back(noted(fmt::format("cycles without a plan, of {}", drive.cycles.size()),
                         static_cast<double>(blind), "", {}));
}

constexpr double kFarthestShown_m = 5.0;
constexpr double kGap = std::numeric_limits<double>::quiet_NaN();

// One value per row, of what is known beside its state.
template <typename Value>
ReportSeries sampled(const Drive& drive, std::string name, Value value) {
  ReportSeries series{.name = std::move(name), .values = {}};
  for (const DriveSample& sample : drive.samples) series.values.push_back(value(sample));
  return series;
}

double if_near(double distance_m) { return distance_m <= kFarthestShown_m ? distance_m : kGap; }

// The audit's lower bound at a time, linear between its samples.
double audited_m(const std::vector<planning::AuditReport::Sample>& profile, double t_s) {
  const auto after =
      std::ranges::lower_bound(profile, t_s, {}, &planning::AuditReport::Sample::t_s);
  if (after == profile.end()) return kGap;
  if (after == profile.begin()) return after->t_s > t_s ? kGap : after->clearance_m;
  const auto before = after - 1;
  const double fraction = (t_s - before->t_s) / (after->t_s - before->t_s);
  return before->clearance_m + fraction * (after->clearance_m - before->clearance_m);
}

ReportPlot speeds_plot(const Drive& drive) {
  ReportPlot plot = speed_plot(drive.trajectory, nullptr);
  plot.series.push_back(
      sampled(drive, "set", [](const DriveSample& s) { return s.set_speed_mps; }));
  plot.series.push_back(
      sampled(drive, "limit", [](const DriveSample& s) { return s.speed_limit_mps; }));
  return plot;
}

ReportPlot accelerations_plot(const Drive& drive) {
  ReportPlot plot = acceleration_plot(drive.trajectory);
  plot.series.insert(plot.series.begin() + 1, sampled(drive, "asked for", [](const DriveSample& s) {
                       return s.command_mps2;
                     }));
  return plot;
}

ReportPlot clearance_plot(const Drive& drive, const std::optional<planning::AuditReport>& audit) {
  std::vector<ReportSeries> series = {
      sampled(drive, "to obstacles", [](const DriveSample& s) { return if_near(s.clearance_m); })};
  if (audit) {
    series.push_back(sampled(drive, "to occupied space", [&](const DriveSample& s) {
      return if_near(audited_m(audit->profile, s.t_s));
    }));
  }
  return plot_over(drive.trajectory, "Clearance up to 5 m", "m", std::move(series));
}

}  // namespace

std::vector<ReportCheck> drive_checks(const Drive& drive,
                                      const std::optional<planning::AuditReport>& audit) {
  std::vector<ReportCheck> checks{outcome_check(drive)};
  if (drive.samples.empty()) return checks;
  checks.push_back(clearance_check(drive));
  if (audit) {
    checks.push_back(audit_check(*audit));
    checks.push_back(noted("swept area never measured", 100.0 * audit->unknown_fraction, "%", {}));
  }
  append_motion_checks(drive, checks);
  append_notes(drive, checks);
  return checks;
}

std::vector<ReportPlot> drive_plots(const Drive& drive,
                                    const std::optional<planning::AuditReport>& audit) {
  return {speeds_plot(drive),
          accelerations_plot(drive),
          curvature_plot(drive.trajectory),
          plot_over(
              drive.trajectory, "Lateral error", "m",
              {sampled(drive, "front axle", [](const DriveSample& s) { return s.cross_track_m; })}),
          plot_over(drive.trajectory, "Heading error", "rad",
                    {sampled(drive, "heading",
                             [](const DriveSample& s) { return s.heading_error_rad; })}),
          clearance_plot(drive, audit)};
}

}  // namespace roadbed::tools::report
