#include "roadbed/tools/report/drive_plots.h"

#include <algorithm>
#include <limits>
#include <string>

#include "roadbed/tools/report/comfort_bounds.h"

namespace roadbed::tools::inline report {
namespace {

using geometry::TrajectoryPoint;

constexpr double kFarthestShown_m = 5.0;
constexpr double kGap = std::numeric_limits<double>::quiet_NaN();

// One value per row, from its state and what else is known of it.
template <typename Value>
ReportSeries series_of(const Drive& drive, std::string name, Value value) {
  ReportSeries series{.name = std::move(name), .values = {}};
  for (std::size_t i = 0; i < drive.samples.size(); ++i) {
    series.values.push_back(value(drive.trajectory.points()[i], drive.samples[i]));
  }
  return series;
}

ReportPlot plot_of(const Drive& drive, std::string title, std::string unit,
                   std::vector<ReportSeries> series) {
  ReportPlot plot{.title = std::move(title),
                  .unit = std::move(unit),
                  .t_s = {},
                  .series = std::move(series),
                  .lower = {},
                  .upper = {}};
  for (const DriveSample& sample : drive.samples) plot.t_s.push_back(sample.t_s);
  return plot;
}

double if_near(double distance_m) { return distance_m <= kFarthestShown_m ? distance_m : kGap; }

// The audit's lower bound at a time, linear between its samples.
double audited_m(const std::vector<planning::AuditReport::Sample>& profile, double t_s) {
  const auto after =
      std::ranges::lower_bound(profile, t_s, {}, &planning::AuditReport::Sample::t_s);
  if (after == profile.end()) return kGap;
  if (after == profile.begin()) return after->t_s > t_s ? kGap : after->clearance_m;
  const auto before = after - 1;
  const double share = (t_s - before->t_s) / (after->t_s - before->t_s);
  return before->clearance_m + share * (after->clearance_m - before->clearance_m);
}

ReportPlot speed_plot(const Drive& drive) {
  using Point = TrajectoryPoint;
  return plot_of(
      drive, "Speed", "m/s",
      {series_of(drive, "speed", [](const Point& p, const DriveSample&) { return p.speed_mps; }),
       series_of(drive, "set", [](const Point&, const DriveSample& s) { return s.set_speed_mps; }),
       series_of(drive, "limit",
                 [](const Point&, const DriveSample& s) { return s.speed_limit_mps; })});
}

ReportPlot acceleration_plot(const Drive& drive) {
  using Point = TrajectoryPoint;
  ReportPlot plot =
      plot_of(drive, "Acceleration", "m/s²",
              {series_of(drive, "along",
                         [](const Point& p, const DriveSample&) { return p.acceleration_mps2; }),
               series_of(drive, "asked for",
                         [](const Point&, const DriveSample& s) { return s.command_mps2; }),
               series_of(drive, "across", [](const Point& p, const DriveSample&) {
                 return p.speed_mps * p.speed_mps * p.curvature_per_m;
               })});
  plot.lower = kLeastAcceleration_mps2;
  plot.upper = kMostAcceleration_mps2;
  return plot;
}

ReportPlot clearance_plot(const Drive& drive, const std::optional<planning::AuditReport>& audit) {
  using Point = TrajectoryPoint;
  std::vector<ReportSeries> series = {
      series_of(drive, "to obstacles",
                [](const Point&, const DriveSample& s) { return if_near(s.clearance_m); })};
  if (audit) {
    series.push_back(series_of(drive, "to occupied space", [&](const Point& p, const DriveSample&) {
      return if_near(audited_m(audit->profile, p.t_s));
    }));
  }
  return plot_of(drive, "Clearance up to 5 m", "m", std::move(series));
}

}  // namespace

std::vector<ReportPlot> drive_plots(const Drive& drive,
                                    const std::optional<planning::AuditReport>& audit) {
  using Point = TrajectoryPoint;
  return {
      speed_plot(drive),
      acceleration_plot(drive),
      plot_of(drive, "Curvature", "1/m",
              {series_of(drive, "driven",
                         [](const Point& p, const DriveSample&) { return p.curvature_per_m; })}),
      plot_of(drive, "Lateral error", "m",
              {series_of(drive, "front axle",
                         [](const Point&, const DriveSample& s) { return s.cross_track_m; })}),
      plot_of(drive, "Heading error", "rad",
              {series_of(drive, "heading",
                         [](const Point&, const DriveSample& s) { return s.heading_error_rad; })}),
      clearance_plot(drive, audit)};
}

}  // namespace roadbed::tools
