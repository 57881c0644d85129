#include "roadbed/tools/report/from_drive.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <iterator>

#include "roadbed/tools/report/surroundings.h"

namespace roadbed::tools::inline report {
namespace {

constexpr double kMapMargin_m = 150.0, kOccupancyMargin_m = 60.0;

Eigen::AlignedBox2d box_around(const std::vector<LineInSource>& route, const Drive& drive,
                               double margin_m) {
  Eigen::AlignedBox2d box;
  for (const LineInSource& line : route) {
    for (const Eigen::Vector2d& point : line) box.extend(point);
  }
  for (const auto& point : drive.trajectory.points()) box.extend(point.pose().position());
  const Eigen::Vector2d margin(margin_m, margin_m);
  return box.isEmpty() ? box : Eigen::AlignedBox2d(box.min() - margin, box.max() + margin);
}

std::vector<DriveEvent> events_of(const Drive& drive,
                                  const std::optional<planning::AuditReport>& audit) {
  std::vector<DriveEvent> events = drive.events;
  if (audit) {
    for (const planning::Conflict& conflict : audit->conflicts) {
      events.push_back({conflict.from_s, EventLevel::fault,
                        fmt::format("occupied space is {:.2f} m near until {:.2f} s",
                                    conflict.least_clearance_m, conflict.to_s)});
    }
  }
  std::ranges::stable_sort(events, {}, &DriveEvent::t_s);
  return events;
}

std::string clearance_text(const planning::AuditReport& audit) {
  return audit.beyond_horizon ? fmt::format("nothing within {:.1f} m", audit.least_clearance_m)
                              : fmt::format("least clearance {:.2f} m at {:.1f} s",
                                            audit.least_clearance_m, audit.least_clearance_at_s);
}

std::optional<ReportVerdict> audit_verdict(const std::optional<planning::AuditReport>& audit) {
  if (!audit) return std::nullopt;
  std::string text =
      fmt::format("{}, {}", planning::to_string(audit->verdict), clearance_text(*audit));
  if (audit->unknown_fraction >= 0.005) {
    text += fmt::format("; {:.0f} % of the swept area was never measured",
                        100.0 * audit->unknown_fraction);
  }
  return ReportVerdict{tone_of(audit->verdict), std::move(text)};
}

map::HeightBand height_band(const geometry::VehicleShape& vehicle) {
  map::HeightBand band;
  band.to_m = vehicle.height_m;
  return band;
}

ReportScene scene_of(const Scenario& scenario, const World& world, const Drive& drive) {
  ReportScene scene;
  scene.vehicle = scenario.vehicle;
  const auto add = [&](const planning::Route& route, const planning::ReferenceLine& line) {
    std::ranges::move(route_lines(world.road_map, route), std::back_inserter(scene.route));
    scene.references.push_back(reference_points(world.road_map, line));
  };
  for (const GivenUpRoute& before : drive.given_up) add(before.route, before.line);
  add(world.route, world.line);
  scene.goal = route_goal(world.road_map, world.route);
  scene.road_map = map_around(world.road_map, box_around(scene.route, drive, kMapMargin_m));
  if (world.occupancy) {
    scene.occupied = occupied_in(*world.occupancy, height_band(scene.vehicle),
                                 box_around(scene.route, drive, kOccupancyMargin_m));
  }
  for (const planning::Obstacle& obstacle : world.obstacles) {
    scene.obstacles.push_back(planning::obstacle_in_source(world.road_map, obstacle));
  }
  return scene;
}

}  // namespace

std::vector<ReportDecision> decisions_of(const Drive& drive) {
  std::vector<ReportDecision> decisions;
  for (const DriveCycle& cycle : drive.cycles) {
    const std::string_view state = to_string(cycle.behaviour);
    if (decisions.empty() || decisions.back().state != state) {
      if (!decisions.empty()) decisions.back().to_s = cycle.t_s;
      decisions.push_back({cycle.t_s, cycle.t_s, std::string(state), cycle.reason});
    }
  }
  if (!decisions.empty()) {
    decisions.back().to_s =
        std::max(drive.cycles.back().t_s,
                 drive.trajectory.empty() ? decisions.back().from_s : drive.trajectory.end_s());
  }
  return decisions;
}

ReportInput report_of(const Scenario& scenario, const World& world, const Drive& drive,
                      const ReportContext& context) {
  ReportInput input;
  input.title = scenario.name;
  input.scenario = scenario.file.string();
  input.verdict = {drive.verdict.outcome == Outcome::goal_reached ? Tone::good : Tone::bad,
                   drive.verdict.text};
  input.audit = audit_verdict(context.audit);
  input.scene = scene_of(scenario, world, drive);
  input.drive = drive;
  input.drive.events = events_of(drive, context.audit);
  input.plots = drive_plots(drive, context.audit);
  input.decisions = decisions_of(drive);
  input.checks = drive_checks(drive, context.audit);
  input.origin = {context.command, context.version, world.road_map.crs(), context.sources};
  input.weights = scenario.options.weights;
  return input;
}

}  // namespace roadbed::tools::report
