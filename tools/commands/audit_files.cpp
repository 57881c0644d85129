#include "roadbed/tools/commands/audit_output.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "roadbed/geometry/polygons/polygon.h"
#include "roadbed/map/files/json_text.h"
#include "roadbed/map/files/xml_characters.h"
#include "roadbed/planning/audit/audit_report.h"
#include "roadbed/tools/files/json.h"

namespace roadbed::tools::inline commands {
namespace {

using Eigen::Vector2d;

std::string audit_case(const AuditedDrive& audited, const std::string& occupancy) {
  std::string text = fmt::format(R"(    <testcase classname="{}" name="{}")",
                                 map::html_text(occupancy), map::html_text(audited.name));
  if (!audited.fault.empty()) {
    return text + fmt::format(">\n      <error message=\"{}\"/>\n    </testcase>\n",
                              map::html_text(audited.fault));
  }
  const std::string report = map::html_text(audit_text(audited.audit.report));
  if (audited.is_clear()) {
    return text + fmt::format(">\n      <system-out>{}</system-out>\n    </testcase>\n", report);
  }
  return text + fmt::format(">\n      <failure message=\"{}\">{}</failure>\n    </testcase>\n",
                            audited.outcome(), report);
}

Json position(const Vector2d& point) { return Json::array({point.x(), point.y()}); }

// GeoJSON wants the first position again at the end.
Json polygon(const geometry::Ring& ring) {
  Json positions = Json::array();
  for (const Vector2d& point : ring) positions.push_back(position(point));
  positions.push_back(position(ring.front()));
  return {{"type", "Polygon"}, {"coordinates", Json::array({std::move(positions)})}};
}

Json feature(Json geometry, Json properties) {
  return {{"type", "Feature"},
          {"geometry", std::move(geometry)},
          {"properties", std::move(properties)}};
}

Json stretch_feature(const AuditedDrive& audited, const planning::JudgedStretch& stretch) {
  Json line = Json::array();
  line.push_back(position(audited.drive.at(stretch.from_s).pose().position()));
  for (const geometry::TrajectoryPoint& sample : audited.drive.points()) {
    if (sample.t_s > stretch.from_s && sample.t_s < stretch.to_s) {
      line.push_back(position(sample.pose().position()));
    }
  }
  line.push_back(position(audited.drive.at(stretch.to_s).pose().position()));
  return feature({{"type", "LineString"}, {"coordinates", std::move(line)}},
                 {{"drive", audited.name},
                  {"kind", "stretch"},
                  {"verdict", planning::to_string(stretch.verdict)},
                  {"from_s", stretch.from_s},
                  {"to_s", stretch.to_s}});
}

// The outlines of all parts; one polygon where there is one part.
Json outlines(const std::vector<geometry::BodyPart>& parts, const geometry::Pose2& pose) {
  if (parts.size() == 1) return polygon(parts.front().outline_at(pose));
  Json polygons = Json::array();
  for (const geometry::BodyPart& part : parts) {
    polygons.push_back(polygon(part.outline_at(pose)).at("coordinates"));
  }
  return {{"type", "MultiPolygon"}, {"coordinates", std::move(polygons)}};
}

void add_conflict(Json& features, const AuditedDrive& audited, const planning::Conflict& conflict,
                  const std::vector<geometry::BodyPart>& parts) {
  const Json about = {{"drive", audited.name},
                      {"kind", "conflict"},
                      {"from_s", conflict.from_s},
                      {"to_s", conflict.to_s},
                      {"at_s", conflict.at.t_s},
                      {"clearance_m", conflict.least_clearance_m},
                      {"overlap_depth_m", conflict.deepest.overlap.depth_m},
                      {"overlap_area_m2", conflict.deepest.overlap.area_m2},
                      {"part", conflict.part},
                      {"obstacle", conflict.obstacle.empty() ? Json() : Json(conflict.obstacle)}};
  features.push_back(feature(outlines(parts, conflict.at.pose()), about));
  Json witness = about;
  witness["kind"] = "witness";
  features.push_back(feature(
      polygon(geometry::box_ring(conflict.witness.min_in_source, conflict.witness.max_in_source)),
      std::move(witness)));
}

}  // namespace

std::string audits_junit(const std::vector<AuditedDrive>& audits, const std::string& occupancy) {
  const auto errors = std::ranges::count(audits, "unusable", &AuditedDrive::outcome);
  const auto clear = std::ranges::count(audits, true, &AuditedDrive::is_clear);
  const auto all = static_cast<std::ptrdiff_t>(audits.size());
  std::string text = fmt::format(
      "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<testsuites>\n"
      "  <testsuite name=\"roadbed audit {}\" tests=\"{}\" failures=\"{}\" errors=\"{}\">\n",
      map::html_text(occupancy), all, all - clear - errors, errors);
  for (const AuditedDrive& audited : audits) text += audit_case(audited, occupancy);
  return text + "  </testsuite>\n</testsuites>\n";
}

std::string audits_geojson(const std::vector<AuditedDrive>& audits,
                           const planning::AuditQuestion& question, const std::string& crs) {
  const std::vector<geometry::BodyPart> parts = question.inflated_parts();
  Json features = Json::array();
  for (const AuditedDrive& audited : audits) {
    if (!audited.fault.empty()) continue;
    const geometry::Trajectory& drive = audited.drive;
    for (const auto& stretch :
         judged_stretches(audited.audit.report, drive.start_s(), drive.end_s())) {
      features.push_back(stretch_feature(audited, stretch));
    }
    for (const planning::Conflict& conflict : audited.audit.report.conflicts) {
      add_conflict(features, audited, conflict, parts);
    }
  }
  const auto text_of = [](const Json& json) { return map::json_text(json); };
  std::string text = "{\"type\":\"FeatureCollection\",\n";
  if (!crs.empty()) {
    text +=
        fmt::format("\"crs\":{},\n", text_of({{"type", "name"}, {"properties", {{"name", crs}}}}));
  }
  text += "\"features\":[";
  for (std::size_t i = 0; i < features.size(); ++i) {
    text += (i == 0 ? "\n" : ",\n") + text_of(features[i]);
  }
  return text + "\n]}\n";
}

}  // namespace roadbed::tools::commands
