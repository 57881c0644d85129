#include "roadbed/tools/report/motion_plots.h"

#include <cmath>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "roadbed/planning/rules/speed_limit.h"
#include "roadbed/tools/simulation/metrics.h"

namespace roadbed::tools::inline report {
namespace {

using Row = geometry::TrajectoryPoint;

template <typename Value>
ReportSeries series_of(const geometry::Trajectory& drive, std::string name, Value value) {
  ReportSeries series{.name = std::move(name), .values = {}};
  for (const Row& row : drive.points()) series.values.push_back(value(row));
  return series;
}

ReportSeries limits_of(const geometry::Trajectory& drive, const map::RoadMap& road_map) {
  ReportSeries limits{.name = "limit", .values = {}};
  for (const auto& limit : planning::limits_along(road_map, drive)) {
    const bool is_drawn = limit && std::isfinite(limit->limit_mps);
    limits.values.push_back(is_drawn ? limit->limit_mps : std::numeric_limits<double>::quiet_NaN());
  }
  return limits;
}

}  // namespace

ReportPlot plot_over(const geometry::Trajectory& drive, std::string title, std::string unit,
                     std::vector<ReportSeries> series) {
  ReportPlot plot{.title = std::move(title),
                  .unit = std::move(unit),
                  .t_s = {},
                  .series = std::move(series),
                  .lower = {},
                  .upper = {}};
  for (const Row& row : drive.points()) plot.t_s.push_back(row.t_s);
  return plot;
}

ReportPlot speed_plot(const geometry::Trajectory& drive, const map::RoadMap* road_map) {
  ReportPlot plot = plot_over(
      drive, "Speed", "m/s", {series_of(drive, "speed", [](const Row& p) { return p.speed_mps; })});
  if (road_map != nullptr) plot.series.push_back(limits_of(drive, *road_map));
  return plot;
}

ReportPlot acceleration_plot(const geometry::Trajectory& drive) {
  ReportPlot plot = plot_over(
      drive, "Acceleration", "m/s²",
      {series_of(drive, "along", [](const Row& p) { return p.acceleration_mps2; }),
       series_of(drive, "across",
                 [](const Row& p) { return p.speed_mps * p.speed_mps * p.curvature_per_m; })});
  plot.lower = kLeastAcceleration_mps2;
  plot.upper = kMostAcceleration_mps2;
  return plot;
}

ReportPlot curvature_plot(const geometry::Trajectory& drive) {
  return plot_over(drive, "Curvature", "1/m",
                   {series_of(drive, "driven", [](const Row& p) { return p.curvature_per_m; })});
}

}  // namespace roadbed::tools::report
