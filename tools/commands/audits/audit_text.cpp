#include "roadbed/tools/commands/audits/audit_output.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>
#include <vector>

#include "roadbed/planning/audit/audit_report.h"

namespace roadbed::tools::inline commands::inline audits {
namespace {

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

// Those of which not all is said by a reason.
std::vector<planning::Stretch> unknown_besides(const planning::AuditReport& report) {
  if (!report.is_measured_enough()) return {};
  std::vector<planning::Stretch> reasoned;
  for (const planning::UnobservedStretch& stretch : report.unobserved) {
    reasoned.push_back({stretch.from_s, stretch.to_s});
  }
  reasoned.insert(reasoned.end(), report.between_poses.begin(), report.between_poses.end());
  reasoned = planning::joined(std::move(reasoned));
  std::vector<planning::Stretch> besides = report.unknown;
  std::erase_if(besides, [&](const planning::Stretch& stretch) {
    return std::ranges::any_of(reasoned, [&](const planning::Stretch& with_reason) {
      return with_reason.from_s <= stretch.from_s && stretch.to_s <= with_reason.to_s;
    });
  });
  return besides;
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

std::string audit_text(const AuditedDrive& audited) {
  std::string text = fmt::format("{:<17}{}\n", "verdict", audited.outcome());
  if (!audited.vehicle_of_drive.empty()) {
    text +=
        fmt::format("{:<17}{}, which the solution names\n", "vehicle", audited.vehicle_of_drive);
  }
  if (audited.has_occupancy) text += clearance_text(audited.audit.report);
  for (const planning::Stretch& stretch : audited.between_poses) {
    text += fmt::format("{:<17}{:.3f} s to {:.3f} s: the log says no pose of the vehicle there\n",
                        "unknown", stretch.from_s, stretch.to_s);
  }
  if (audited.road) {
    text += surface_text(*audited.road);
    for (const planning::RuleReport& rule : audited.road->rules) {
      text += rule_text(rule, audited.road->counts(rule.rule));
    }
  }
  return text;
}

std::string least_text(const AuditedDrive& audited) {
  return audited.has_occupancy ? least_text(audited.audit.report)
                               : margin_text(audited.road->surface);
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

}  // namespace roadbed::tools::commands::audits
