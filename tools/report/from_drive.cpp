#include "roadbed/tools/report/from_drive.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "roadbed/tools/report/drive_checks.h"
#include "roadbed/tools/report/drive_plots.h"
#include "roadbed/tools/report/from_map.h"
#include "roadbed/tools/report/from_occupancy.h"

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

// "ends 0.4 m to the left after 22.0 m".
std::string note_of(const DriveCycle& cycle) {
  if (!cycle.chosen) return cycle.plan_reason.empty() ? "none feasible" : cycle.plan_reason;
  const double end_d_m = cycle.chosen->end_d_m;
  const char* side = end_d_m > 0.0 ? "to the left" : "to the right";
  return std::abs(end_d_m) < 0.05
             ? fmt::format("ends on the reference line after {:.1f} m", cycle.chosen->end_l_m)
             : fmt::format("ends {:.1f} m {} after {:.1f} m", std::abs(end_d_m), side,
                           cycle.chosen->end_l_m);
}

ReportCandidate candidate_of(const planning::Candidate& from) {
  static const planning::CostTerms weights = planning::default_weights();
  ReportCandidate candidate{from.end_d_m, from.end_l_m, {}};
  for (std::size_t i = 0; i < weights.size(); ++i) {
    candidate.costs.push_back(weights[i] * from.terms[i]);
  }
  return candidate;
}

ReportPlan plan_of(const DriveCycle& cycle) {
  ReportPlan plan{.t_s = cycle.t_s,
                  .path = cycle.path,
                  .note = note_of(cycle),
                  .reason = cycle.reason,
                  .start = {cycle.start.s_m, cycle.start.d_m, cycle.start.d_slope,
                            cycle.start.d_curvature_per_m}};
  if (cycle.chosen) plan.chosen = candidate_of(*cycle.chosen);
  if (!cycle.grid) return plan;
  if (cycle.grid->runner_up) plan.runner_up = candidate_of(*cycle.grid->runner_up);
  plan.grid = ReportGrid{cycle.grid->end_d_m, cycle.grid->end_l_m, cycle.grid->causes};
  return plan;
}

void add_plans(const Drive& drive, ReportInput& input) {
  for (const DriveCycle& cycle : drive.cycles) input.plans.push_back(plan_of(cycle));
  for (int i = 0; i < planning::kCostTerms; ++i) {
    input.cost_names.emplace_back(planning::name(static_cast<planning::CostTerm>(i)));
  }
  for (int i = 0; i < planning::kRejections; ++i) {
    input.cause_names.emplace_back(planning::name(static_cast<planning::Rejection>(i)));
  }
}

Severity severity_of(EventLevel level) {
  switch (level) {
    case EventLevel::info:
      return Severity::info;
    case EventLevel::warning:
      return Severity::warning;
    case EventLevel::fault:
      return Severity::fault;
  }
  return Severity::fault;
}

std::vector<ReportEvent> events_of(const Drive& drive,
                                   const std::optional<planning::AuditReport>& audit) {
  std::vector<ReportEvent> events;
  for (const DriveEvent& event : drive.events) {
    events.push_back({event.t_s, severity_of(event.level), event.text});
  }
  if (audit) {
    for (const planning::Conflict& conflict : audit->conflicts) {
      events.push_back({conflict.from_s, Severity::fault,
                        fmt::format("occupied space is {:.2f} m near until {:.2f} s",
                                    conflict.least_clearance_m, conflict.to_s)});
    }
  }
  std::ranges::stable_sort(events, {}, &ReportEvent::t_s);
  return events;
}

Tone tone_of(planning::Verdict verdict) {
  switch (verdict) {
    case planning::Verdict::clear:
      return Tone::good;
    case planning::Verdict::conflict:
      return Tone::bad;
    case planning::Verdict::unknown:
    case planning::Verdict::undecided:
      return Tone::open;
  }
  return Tone::open;
}

std::string clearance_text(const planning::AuditReport& audit) {
  return audit.beyond_horizon ? fmt::format("nothing within {:.1f} m", audit.least_clearance_m)
                              : fmt::format("least clearance {:.2f} m at {:.1f} s",
                                            audit.least_clearance_m, audit.least_clearance_at_s);
}

std::optional<ReportVerdict> audit_verdict(const std::optional<planning::AuditReport>& audit) {
  if (!audit) return std::nullopt;
  std::string text = fmt::format("{}, {}", planning::name(audit->verdict), clearance_text(*audit));
  if (audit->unknown_share >= 0.005) {
    text += fmt::format("; {:.0f} % of the swept area was never measured",
                        100.0 * audit->unknown_share);
  }
  return ReportVerdict{tone_of(audit->verdict), std::move(text)};
}

map::HeightBand height_band(const geometry::VehicleShape& vehicle) {
  map::HeightBand band;
  band.to_m = vehicle.height_m;
  return band;
}

void add_surroundings(const World& world, const Drive& drive, ReportInput& input) {
  input.route = route_lines(world.road_map, world.route);
  input.reference = reference_points(world.road_map, world.line);
  input.goal = route_goal(world.road_map, world.route);
  input.lanes = lanes_in(world.road_map, box_around(input.route, drive, kMapMargin_m));
  if (world.occupancy) {
    input.occupied = occupied_in(*world.occupancy, height_band(input.vehicle),
                                 box_around(input.route, drive, kOccupancyMargin_m));
  }
  for (const planning::Obstacle& obstacle : world.obstacles) {
    input.obstacles.push_back(planning::obstacle_in_source(world.road_map, obstacle));
  }
}

}  // namespace

std::vector<ReportDecision> decisions_of(const Drive& drive) {
  std::vector<ReportDecision> decisions;
  for (const DriveCycle& cycle : drive.cycles) {
    const std::string_view state = name(cycle.behaviour);
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
  input.vehicle = scenario.vehicle;
  input.drive = drive.trajectory;
  add_plans(drive, input);
  input.plots = drive_plots(drive, context.audit);
  input.events = events_of(drive, context.audit);
  input.decisions = decisions_of(drive);
  input.checks = drive_checks(drive, context.audit);
  input.command = context.command;
  input.version = context.version;
  input.crs = world.road_map.crs();
  input.sources = context.sources;
  add_surroundings(world, drive, input);
  return input;
}

}  // namespace roadbed::tools
