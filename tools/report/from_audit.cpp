#include "roadbed/tools/report/audit_pages.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <limits>
#include <utility>

#include "roadbed/planning/audit/audit_report.h"
#include "roadbed/tools/report/audit_pictures.h"
#include "roadbed/tools/report/comfort.h"
#include "roadbed/tools/report/derived_dynamics.h"
#include "roadbed/tools/report/motion_plots.h"
#include "roadbed/tools/report/surroundings.h"

namespace roadbed::tools::inline report {
namespace {

using planning::AuditReport;
using planning::Verdict;

constexpr double kShownBelow_m = 5.0;  // more room is a gap in the plot

std::string thing_of(const std::string& obstacle, bool is_of_surface) {
  if (!obstacle.empty()) return "obstacle " + obstacle;
  return is_of_surface ? "the edge of its surface" : "occupied space";
}

ReportVerdict verdict_of(const AuditReport& report, bool is_of_surface) {
  if (report.beyond_horizon) {
    return {tone_of(report.verdict),
            fmt::format("{}: nothing within {:.0f} m", to_string(report.verdict),
                        report.least_clearance_m)};
  }
  return {tone_of(report.verdict), fmt::format("{}: least clearance {:.2f} m at {:.2f} s, {} to {}",
                                               to_string(report.verdict), report.least_clearance_m,
                                               report.least_clearance_at_s, report.part,
                                               thing_of(report.obstacle, is_of_surface))};
}

ReportPlot clearance_by_row(const AuditReport& report, double clearance_m) {
  ReportPlot plot;
  plot.title = "Clearance up to 5 m";
  plot.unit = "m";
  ReportSeries series{.name = "to the nearest thing", .values = {}};
  for (const AuditReport::Sample& sample : report.profile) {
    plot.t_s.push_back(sample.t_s);
    series.values.push_back(sample.clearance_m < kShownBelow_m
                                ? sample.clearance_m
                                : std::numeric_limits<double>::quiet_NaN());
  }
  plot.series.push_back(std::move(series));
  plot.lower = clearance_m;
  return plot;
}

std::string nearness_text(const planning::Conflict& conflict) {
  const double depth_m = conflict.deepest.overlap.depth_m;
  return depth_m > 0.0 ? fmt::format("{:.2f} m deep in", depth_m)
                       : fmt::format("{:.2f} m from", conflict.least_clearance_m);
}

std::vector<DriveEvent> events_of_audit(const AuditReport& report, bool is_of_surface) {
  std::vector<DriveEvent> events;
  for (const planning::Conflict& conflict : report.conflicts) {
    const std::string with =
        fmt::format("{}, {}", thing_of(conflict.obstacle, is_of_surface), conflict.part);
    events.push_back({conflict.from_s, EventLevel::fault, "conflict begins: " + with});
    events.push_back(
        {conflict.at.t_s, EventLevel::fault, fmt::format("{} {}", nearness_text(conflict), with)});
  }
  for (const planning::UnobservedStretch& stretch : report.unobserved) {
    events.push_back(
        {stretch.from_s, EventLevel::fault,
         fmt::format("nothing was measured near the {}: {}", stretch.part, stretch.reason)});
  }
  for (const planning::Stretch& stretch : report.between_poses) {
    events.push_back({stretch.from_s, EventLevel::fault,
                      fmt::format("the log says no pose until {:.3f} s", stretch.to_s)});
  }
  for (const planning::Stretch& stretch : report.unknown) {
    const auto is_it = [&](const planning::Stretch& between) {
      return between.from_s <= stretch.from_s && stretch.to_s <= between.to_s;
    };
    if (std::ranges::any_of(report.between_poses, is_it)) continue;
    events.push_back({stretch.from_s, EventLevel::warning, "near space that was not measured"});
  }
  return events;
}

std::vector<geometry::Ring> rings_of(const map::RoadMap* road_map) {
  std::vector<geometry::Ring> rings;
  if (road_map == nullptr) return rings;
  for (const map::Lane& lane : road_map->lanes()) {
    rings.push_back(outline_in_source(*road_map, lane));
  }
  return rings;
}

std::string reason_of(Verdict verdict) {
  switch (verdict) {
    case Verdict::clear:
      return "proven to keep its clearance";
    case Verdict::conflict:
      return "nearer than its clearance";
    case Verdict::unknown:
      return "near space that was not measured";
    case Verdict::undecided:
      return "within 1 mm of its clearance";
  }
  return {};
}

std::vector<ReportCheck> checks_of(const AuditReport& report, double clearance_m) {
  return {{.name = report.beyond_horizon ? "clearance, at least" : "least clearance",
           .value = report.least_clearance_m,
           .unit = "m",
           .bound = fmt::format("≥ {:.2f}", clearance_m),
           .passed = report.conflicts.empty(),
           .at_s = report.least_clearance_at_s,
           .bound_from = "--clearance"},
          {.name = "proven clearance",
           .value = report.proven_clearance_m,
           .unit = "m",
           .bound = {},
           .passed = true,
           .at_s = {}},
          {.name = "swept area never measured",
           .value = 100.0 * report.unknown_fraction,
           .unit = "%",
           .bound = fmt::format("≤ {:g}", 100.0 * (1.0 - report.least_measured)),
           .passed = report.is_measured_enough(),
           .at_s = {},
           .bound_from = "--least-measured"},
          {.name = "stretches without anything measured near",
           .value = static_cast<double>(report.unobserved.size()),
           .unit = "",
           .bound = "≤ 0",
           .passed = report.unobserved.empty(),
           .at_s = report.unobserved.empty() ? std::nullopt
                                             : std::optional(report.unobserved.front().from_s),
           .bound_from = "the audit"}};
}

ReportInput drive_among(const AuditSurroundings& around, const geometry::Trajectory& drive) {
  ReportInput input;
  input.title = input.scenario = around.name;
  input.scene.road_map = around.road_map;
  input.scene.occupied = around.occupied;
  input.scene.vehicle = around.body;
  if (around.parts.size() > 1) {
    for (const geometry::BodyPart& part : around.parts) {
      input.scene.parts_in_vehicle.push_back(part.outline_at({0.0, 0.0, 0.0}));
    }
  }
  input.scene.obstacles = around.moving;
  input.drive.trajectory = drive;
  input.origin = {around.command, around.version, around.crs, around.sources};
  return input;
}

}  // namespace

ReportInput report_of_audit(const geometry::Trajectory& drive, const AuditReport& report,
                            const AuditSurroundings& around) {
  ReportInput input = drive_among(around, drive);
  input.title = "Audit of " + around.name;
  input.verdict = verdict_of(report, around.is_of_surface);
  input.plots = {clearance_by_row(report, around.clearance_m),
                 speed_plot(drive, around.road_map.get())};
  input.drive.events = events_of_audit(report, around.is_of_surface);
  std::ranges::copy(around.events, std::back_inserter(input.drive.events));
  std::ranges::stable_sort(input.drive.events, {}, &DriveEvent::t_s);
  for (const auto& stretch : judged_stretches(report, drive.start_s(), drive.end_s())) {
    input.decisions.push_back({stretch.from_s, stretch.to_s,
                               std::string(to_string(stretch.verdict)),
                               reason_of(stretch.verdict)});
  }
  input.checks = checks_of(report, around.clearance_m);
  std::ranges::copy(around.checks, std::back_inserter(input.checks));
  input.pictures =
      close_ups(report, {drive, around.parts, [&](const map::Box2&) { return around.occupied; },
                         rings_of(around.road_map.get()), around.moving});
  return input;
}

ReportInput report_of_recording(const geometry::Trajectory& recorded,
                                const std::optional<AuditReport>& report,
                                const AuditSurroundings& around) {
  const geometry::Trajectory drive = with_dynamics(recorded, around.body.wheelbase_m);
  ReportInput input = drive_among(around, drive);
  if (report) {
    input = report_of_audit(drive, *report, around);
  } else {
    input.verdict = {Tone::open, "recorded; nothing was asked of it"};
    input.plots = {speed_plot(drive, around.road_map.get())};
  }
  input.plots.push_back(acceleration_plot(drive));
  input.plots.push_back(curvature_plot(drive));
  std::ranges::move(comfort_checks(drive), std::back_inserter(input.checks));
  return input;
}

}  // namespace roadbed::tools::report
