#pragma once

#include <string>
#include <vector>

#include "roadbed/geometry/motion/trajectory.h"
#include "roadbed/map/model/road_map.h"
#include "roadbed/tools/report/report.h"

namespace roadbed::tools::inline report {

/// A diagram over the times of a drive's rows.
ReportPlot plot_over(const geometry::Trajectory& drive, std::string title, std::string unit,
                     std::vector<ReportSeries> series);

// Diagrams of how a drive moved, a value a row.

/// Speed, and the limit of the lanes that the drive is in.
/// @param road_map  near the drive; null: no limit.
ReportPlot speed_plot(const geometry::Trajectory& drive, const map::RoadMap* road_map);

/// Along and across, with the bounds of comfort.
ReportPlot acceleration_plot(const geometry::Trajectory& drive);

ReportPlot curvature_plot(const geometry::Trajectory& drive);

}  // namespace roadbed::tools::report
