#include "roadbed/tools/commands/audit_output.h"
#include "roadbed/tools/files/json.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <utility>
#include <vector>

#include "roadbed/planning/audit/audit_report.h"

namespace roadbed::tools::inline commands {
namespace {

Json box_json(const map::Box2& box) {
  return {{"min_x_m", box.min_in_source.x()},
          {"min_y_m", box.min_in_source.y()},
          {"max_x_m", box.max_in_source.x()},
          {"max_y_m", box.max_in_source.y()}};
}

Json state_json(const geometry::TrajectoryPoint& state) {
  return {{"t_s", state.t_s},
          {"x_m", state.x_m},
          {"y_m", state.y_m},
          {"heading_rad", state.heading_rad}};
}

Json id_json(const std::string& obstacle) { return obstacle.empty() ? Json() : Json(obstacle); }

Json overlap_json(const planning::DeepestOverlap& deepest) {
  if (deepest.overlap.depth_m == 0.0) return nullptr;
  return {{"depth_m", deepest.overlap.depth_m},
          {"area_m2", deepest.overlap.area_m2},
          {"at_s", deepest.at_s}};
}

Json unobserved_json(const std::vector<planning::UnobservedStretch>& stretches) {
  Json json = Json::array();
  for (const planning::UnobservedStretch& stretch : stretches) {
    json.push_back({{"from_s", stretch.from_s},
                    {"to_s", stretch.to_s},
                    {"part", stretch.part},
                    {"reason", stretch.reason}});
  }
  return json;
}

Json conflict_json(const planning::Conflict& conflict, const geometry::Trajectory& drive) {
  return {{"from_s", conflict.from_s},
          {"to_s", conflict.to_s},
          {"from", state_json(drive.at(conflict.from_s))},
          {"least_clearance_m", conflict.least_clearance_m},
          {"overlap", overlap_json(conflict.deepest)},
          {"at", state_json(conflict.at)},
          {"part", conflict.part},
          {"obstacle", id_json(conflict.obstacle)},
          {"witness", box_json(conflict.witness)}};
}

Json judged_json(const std::vector<planning::JudgedStretch>& stretches) {
  Json json = Json::array();
  for (const planning::JudgedStretch& stretch : stretches) {
    json.push_back({{"from_s", stretch.from_s},
                    {"to_s", stretch.to_s},
                    {"verdict", planning::to_string(stretch.verdict)}});
  }
  return json;
}

Json times_json(const std::vector<planning::Stretch>& stretches) {
  Json json = Json::array();
  for (const planning::Stretch& stretch : stretches) {
    json.push_back({{"from_s", stretch.from_s}, {"to_s", stretch.to_s}});
  }
  return json;
}

// "the cell at (1.00, 2.00)", "obstacle 17 at (1.00, 2.00)".
std::string thing_text(const map::Box2& box, const std::string& obstacle) {
  const Eigen::Vector2d middle = 0.5 * (box.min_in_source + box.max_in_source);
  return fmt::format("{} at ({:.2f}, {:.2f})",
                     obstacle.empty() ? "the cell" : "obstacle " + obstacle, middle.x(),
                     middle.y());
}

std::string least_text(const planning::AuditReport& report) {
  if (report.beyond_horizon) {
    return fmt::format("over {:.0f} m all along: nothing is nearer\n", report.least_clearance_m);
  }
  return fmt::format("{:.3f} m at {:.3f} s, {}, from {}; nowhere under {:.3f} m\n",
                     report.least_clearance_m, report.least_clearance_at_s, report.part,
                     thing_text(*report.witness, report.obstacle), report.proven_clearance_m);
}

std::string demand_text(const planning::AuditReport& report) {
  if (report.least_measured == 0.0) return {};
  return fmt::format(", {} {:g} % was to be measured{}",
                     report.is_measured_enough() ? "and at least" : "but at least",
                     100.0 * report.least_measured,
                     report.is_measured_enough() ? "" : ": all of the drive is unknown");
}

// "front, 0.120 m from the cell at (1.00, 2.00) at 1.250 s, at (0.10, 2.00)", or how deep it is.
std::string conflict_text(const planning::Conflict& conflict) {
  const std::string thing = thing_text(conflict.witness, conflict.obstacle);
  const std::string place = fmt::format("at {:.3f} s, at ({:.2f}, {:.2f})", conflict.at.t_s,
                                        conflict.at.x_m, conflict.at.y_m);
  const planning::DeepestOverlap& deepest = conflict.deepest;
  if (conflict.least_clearance_m > 0.0) {
    return fmt::format("{}, {:.3f} m from {} {}", conflict.part, conflict.least_clearance_m, thing,
                       place);
  }
  if (deepest.overlap.depth_m == 0.0) {
    return fmt::format("{} touches {} {}", conflict.part, thing, place);
  }
  return fmt::format("{} overlaps {} {}; {:.3f} m deep, {:.3f} m² at {:.3f} s", conflict.part,
                     thing, place, deepest.overlap.depth_m, deepest.overlap.area_m2, deepest.at_s);
}

Json point_json(const Eigen::Vector2d& point) { return {{"x_m", point.x()}, {"y_m", point.y()}}; }

Json excursion_json(const planning::Excursion& out) {
  return {{"from_s", out.from_s},
          {"to_s", out.to_s},
          {"from", state_json(out.from)},
          {"at", state_json(out.at)},
          {"least_margin_m", out.least_margin_m},
          {"depth_m", out.depth_m},
          {"part", out.part},
          {"point", point_json(out.point_in_source)},
          {"edge", point_json(out.edge_in_source)},
          {"onto",
           {{"kind", planning::to_string(out.onto.kind)},
            {"name", id_json(out.onto.name)},
            {"type", id_json(out.onto.type)}}}};
}

Json surface_json(const RoadAudit& road, const geometry::Trajectory& drive) {
  const planning::SurfaceReport& surface = road.surface;
  Json excursions = Json::array();
  for (const planning::Excursion& out : surface.conflicts) {
    excursions.push_back(excursion_json(out));
  }
  return {{"on", road.on},
          {"verdict", planning::to_string(surface.verdict)},
          {"margin_m", road.margin_m},
          {"seam_m", road.seam_m},
          {"least_margin_m", surface.least_margin_m},
          {"proven_margin_m", surface.proven_margin_m},
          {"least_margin_at_s", surface.least_margin_at_s},
          {"beyond_horizon", surface.beyond_horizon},
          {"part", surface.beyond_horizon ? Json() : Json(surface.part)},
          {"edge", surface.beyond_horizon ? Json() : point_json(surface.edge_in_source)},
          {"excursions", std::move(excursions)},
          {"undecided", times_json(surface.undecided)},
          {"stretches", judged_json(judged_stretches(surface, drive.start_s(), drive.end_s()))}};
}

bool counts(const RoadAudit& road, planning::TrafficRule rule) {
  return std::ranges::count(road.counted, rule) > 0;
}

Json rules_json(const RoadAudit& road) {
  Json json = Json::object();
  for (const planning::RuleReport& rule : road.rules) {
    Json violations = Json::array();
    for (const planning::Violation& one : rule.violations) {
      violations.push_back({{"from_s", one.from_s},
                            {"to_s", one.to_s},
                            {"at", state_json(one.at)},
                            {"lane", one.lane},
                            {"text", one.text}});
    }
    json[std::string(planning::to_string(rule.rule))] = {
        {"verdict", planning::to_string(rule.verdict)},
        {"counts", counts(road, rule.rule)},
        {"violations", std::move(violations)},
        {"unknown", times_json(rule.unknown)},
        {"reason", id_json(rule.reason)}};
  }
  return json;
}

// Those of which not all is said by a reason.
std::vector<planning::Stretch> unknown_besides(const planning::AuditReport& report) {
  if (!report.is_measured_enough()) return {};
  std::vector<planning::Stretch> reasoned;
  for (const planning::UnobservedStretch& stretch : report.unobserved) {
    reasoned.push_back({stretch.from_s, stretch.to_s});
  }
  reasoned = planning::joined(std::move(reasoned));
  std::vector<planning::Stretch> besides = report.unknown;
  std::erase_if(besides, [&](const planning::Stretch& stretch) {
    return std::ranges::any_of(reasoned, [&](const planning::Stretch& with_reason) {
      return with_reason.from_s <= stretch.from_s && stretch.to_s <= with_reason.to_s;
    });
  });
  return besides;
}

constexpr std::array<std::string_view, 5> kOutcomes{"clear", "conflict", "unknown", "undecided",
                                                    "unusable"};

std::ptrdiff_t parts_counted(const std::vector<AuditedDrive>& audits, std::string_view outcome) {
  return std::ranges::count(audits, outcome, &AuditedDrive::outcome);
}

std::string_view gravest(const std::vector<AuditedDrive>& audits) {
  for (const std::string_view outcome : {"unusable", "conflict", "unknown", "undecided"}) {
    if (parts_counted(audits, outcome) > 0) return outcome;
  }
  return "clear";
}

std::string table_row(const AuditedDrive& audited, std::size_t width) {
  const std::string head = fmt::format("{:<{}}  {:<9}", audited.name, width, audited.outcome());
  if (!audited.fault.empty()) return fmt::format("{}  {}\n", head, audited.fault);
  const planning::AuditReport report = audited.whole();
  std::string conflict;
  if (!report.conflicts.empty()) {
    const geometry::TrajectoryPoint from = audited.drive.at(report.conflicts.front().from_s);
    conflict = fmt::format("{:.3f} s at ({:.2f}, {:.2f}), {}", from.t_s, from.x_m, from.y_m,
                           report.conflicts.front().part);
  }
  std::string row = fmt::format(
      "{}  {:>11}  {:>9.3f}  {:>7.1f} %  {}", head,
      fmt::format("{}{:.3f}", report.beyond_horizon ? "over " : "", report.least_clearance_m),
      report.least_clearance_at_s, 100.0 * report.unknown_fraction, conflict);
  row.erase(row.find_last_not_of(' ') + 1);
  return row + "\n";
}

void add_clearance(const AuditedDrive& audited, Json& json) {
  const planning::AuditReport& report = audited.audit.report;
  json["least_clearance_m"] = report.least_clearance_m;
  json["proven_clearance_m"] = report.proven_clearance_m;
  json["least_clearance_at_s"] = report.least_clearance_at_s;
  json["beyond_horizon"] = report.beyond_horizon;
  json["witness"] = report.witness ? box_json(*report.witness) : Json();
  json["obstacle"] = id_json(report.obstacle);
  json["part"] = report.witness ? Json(report.part) : Json();
  json["unknown_share"] = report.unknown_fraction;
  json["least_measured"] = report.least_measured;
  json["conflicts"] = Json::array();
  for (const auto& conflict : report.conflicts) {
    json["conflicts"].push_back(conflict_json(conflict, audited.drive));
  }
  json["unknown"] = times_json(report.unknown);
  json["unobserved"] = unobserved_json(report.unobserved);
  json["undecided"] = times_json(report.undecided);
}

std::string clearance_text(const planning::AuditReport& report) {
  std::string text = fmt::format("{:<17}", "least clearance") + least_text(report);
  text += fmt::format("{:<17}{:.1f} % of the space that the vehicle takes{}\n", "not measured",
                      100.0 * report.unknown_fraction, demand_text(report));
  for (const planning::Conflict& conflict : report.conflicts) {
    text += fmt::format("{:<17}{:.3f} s to {:.3f} s: {}\n", "conflict", conflict.from_s,
                        conflict.to_s, conflict_text(conflict));
  }
  for (const planning::UnobservedStretch& stretch : report.unobserved) {
    text += fmt::format(
        "{:<17}{:.3f} s to {:.3f} s: nothing was measured within {} m of the {}: {}\n", "unknown",
        stretch.from_s, stretch.to_s, planning::kObservedWithin_m, stretch.part, stretch.reason);
  }
  for (const planning::Stretch& stretch : unknown_besides(report)) {
    text += fmt::format(
        "{:<17}{:.3f} s to {:.3f} s: near space that was not measured; measure it, "
        "or give --unknown\n",
        "unknown", stretch.from_s, stretch.to_s);
  }
  for (const planning::Stretch& stretch : report.undecided) {
    text += fmt::format("{:<17}{:.3f} s to {:.3f} s: within 1 mm of the clearance asked for\n",
                        "undecided", stretch.from_s, stretch.to_s);
  }
  return text;
}

std::string margin_text(const planning::SurfaceReport& surface) {
  if (surface.beyond_horizon) {
    return surface.verdict == planning::Verdict::conflict
               ? "nowhere near"
               : fmt::format("over {} m from its edge all along", planning::kSurfaceHorizon_m);
  }
  if (surface.least_margin_m == 0.0) {
    return fmt::format("off it at {:.3f} s, {}", surface.least_margin_at_s, surface.part);
  }
  return fmt::format(
      "least margin {:.3f} m at {:.3f} s, {}, from its edge at ({:.2f}, {:.2f}); "
      "nowhere under {:.3f} m",
      surface.least_margin_m, surface.least_margin_at_s, surface.part, surface.edge_in_source.x(),
      surface.edge_in_source.y(), surface.proven_margin_m);
}

// "off 1.2 s to 3.4 s: from (1.00, 2.00); front left corner 0.812 m off at 2.1 s, at (…), onto …".
std::string excursion_text(const planning::Excursion& out) {
  const bool is_off = out.depth_m > 0.0;
  return fmt::format(
      "{:<17}{:.3f} s to {:.3f} s: from ({:.2f}, {:.2f}); {} {:.3f} m {} at {:.3f} s, at "
      "({:.2f}, {:.2f}), {} {}\n",
      is_off ? "off" : "near the edge", out.from_s, out.to_s, out.from.x_m, out.from.y_m, out.part,
      is_off ? out.depth_m : out.least_margin_m, is_off ? "off" : "from it", out.at.t_s,
      out.point_in_source.x(), out.point_in_source.y(), is_off ? "onto" : "beside",
      planning::text_of(out.onto));
}

}  // namespace

Json audit_json(const AuditedDrive& audited) {
  const geometry::Trajectory& drive = audited.drive;
  Json json;
  json["verdict"] = std::string(audited.outcome());
  if (audited.has_occupancy) add_clearance(audited, json);
  json["stretches"] =
      judged_json(judged_stretches(audited.whole(), drive.start_s(), drive.end_s()));
  if (audited.road) {
    json["surface"] = surface_json(*audited.road, drive);
    json["rules"] = rules_json(*audited.road);
  }
  return json;
}

std::string audit_text(const AuditedDrive& audited) {
  std::string text = fmt::format("{:<17}{}\n", "verdict", audited.outcome());
  if (audited.has_occupancy) text += clearance_text(audited.audit.report);
  if (audited.road) {
    text += surface_text(*audited.road);
    for (const planning::RuleReport& rule : audited.road->rules) {
      text += rule_text(rule, counts(*audited.road, rule.rule));
    }
  }
  return text;
}

std::string surface_text(const RoadAudit& road) {
  const planning::SurfaceReport& surface = road.surface;
  std::string text =
      fmt::format("{:<17}{}, on {}: {}\n", "surface", planning::to_string(surface.verdict), road.on,
                  margin_text(surface));
  for (const planning::Excursion& out : surface.conflicts) text += excursion_text(out);
  for (const planning::Stretch& stretch : surface.undecided) {
    text += fmt::format("{:<17}{:.3f} s to {:.3f} s: within {:.1f} mm of the margin asked for\n",
                        "undecided", stretch.from_s, stretch.to_s, 1e3 * (1e-3 + surface.off_by_m));
  }
  return text;
}

std::string rule_text(const planning::RuleReport& rule, bool counts) {
  std::string text =
      fmt::format("{:<17}{}{}\n", planning::to_string(rule.rule), planning::to_string(rule.verdict),
                  counts ? "" : ", does not count: --rules");
  for (const planning::Violation& one : rule.violations) {
    text += fmt::format("{:<17}{:.3f} s to {:.3f} s: lane {}: {}, at ({:.2f}, {:.2f})\n", "broken",
                        one.from_s, one.to_s, one.lane, one.text, one.at.x_m, one.at.y_m);
  }
  if (!rule.unknown.empty()) {
    text += fmt::format("{:<17}{:.3f} s to {:.3f} s{}: {}\n", "unknown",
                        rule.unknown.front().from_s, rule.unknown.back().to_s,
                        rule.unknown.size() > 1 ? ", in parts" : "", rule.reason);
  }
  return text;
}

Json audits_json(const std::vector<AuditedDrive>& audits) {
  Json json;
  json["verdict"] = gravest(audits);
  json["counts"] = Json::object();
  for (const std::string_view outcome : kOutcomes) {
    json["counts"][std::string(outcome)] = parts_counted(audits, outcome);
  }
  json["audits"] = Json::array();
  for (const AuditedDrive& audited : audits) {
    Json one{{"drive", audited.name}};
    if (audited.fault.empty()) {
      one.update(audit_json(audited));
    } else {
      one.update(Json{{"verdict", audited.outcome()}, {"fault", audited.fault}});
    }
    json["audits"].push_back(std::move(one));
  }
  return json;
}

IndexedAudit indexed(const AuditedDrive& audited) {
  IndexedAudit index{.name = audited.name,
                     .tone = audited.is_clear() ? Tone::good : Tone::bad,
                     .outcome = std::string(audited.outcome()),
                     .least = {},
                     .text = audited.fault,
                     .pictures = {}};
  if (!audited.fault.empty()) return index;
  if (index.outcome == "unknown" || index.outcome == "undecided") index.tone = Tone::open;
  index.least =
      audited.has_occupancy ? least_text(audited.audit.report) : margin_text(audited.road->surface);
  index.text = audit_text(audited);
  return index;
}

std::string audits_table(const std::vector<AuditedDrive>& audits) {
  std::size_t width = 5;
  for (const AuditedDrive& audited : audits) width = std::max(width, audited.name.size());
  std::string text = fmt::format("{:<{}}  {:<9}  {:>11}  {:>9}  {:>9}  {}\n", "drive", width,
                                 "verdict", "least [m]", "at [s]", "unknown", "first conflict");
  for (const AuditedDrive& audited : audits) text += table_row(audited, width);
  text += fmt::format("{} drives:", audits.size());
  for (const std::string_view outcome : kOutcomes) {
    text += fmt::format("{} {} {}", outcome == kOutcomes.front() ? "" : ",",
                        parts_counted(audits, outcome), outcome);
  }
  return text + "\n";
}

}  // namespace roadbed::tools::commands
