#include "roadbed/tools/commands/audits/audit_output.h"

#include <string>
#include <utility>
#include <vector>

#include "roadbed/planning/audit/audit_report.h"
#include "roadbed/tools/files/json.h"

namespace roadbed::tools::inline commands::inline audits {
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
        {"counts", road.counts(rule.rule)},
        {"violations", std::move(violations)},
        {"unknown", times_json(rule.unknown)},
        {"reason", id_json(rule.reason)}};
  }
  return json;
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

}  // namespace

Json audit_json(const AuditedDrive& audited) {
  const geometry::Trajectory& drive = audited.drive;
  Json json;
  json["verdict"] = std::string(audited.outcome());
  if (!audited.vehicle_of_drive.empty()) json["vehicle"] = audited.vehicle_of_drive;
  if (audited.has_occupancy) add_clearance(audited, json);
  json["between_poses"] = times_json(audited.between_poses);
  json["stretches"] =
      judged_json(judged_stretches(audited.whole(), drive.start_s(), drive.end_s()));
  if (audited.road) {
    json["surface"] = surface_json(*audited.road, drive);
    json["rules"] = rules_json(*audited.road);
  }
  return json;
}

}  // namespace roadbed::tools::commands::audits
