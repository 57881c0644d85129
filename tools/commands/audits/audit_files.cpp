#include "roadbed/tools/commands/audits/audit_output.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "roadbed/geometry/polygons/polygon.h"
#include "roadbed/map/files/json_text.h"
#include "roadbed/map/files/xml_characters.h"
#include "roadbed/planning/audit/audit_report.h"
#include "roadbed/tools/files/json.h"

namespace roadbed::tools::inline commands::inline audits {
namespace {

using Eigen::Vector2d;

// A test case with the text of what was found.
std::string audit_case(const std::string& suite, const std::string& name, std::string_view outcome,
                       const std::string& text) {
  const std::string head = fmt::format(R"(    <testcase classname="{}" name="{}")",
                                       map::html_text(suite), map::html_text(name));
  const std::string found = map::html_text(text);
  if (outcome == "clear") {
    return head + fmt::format(">\n      <system-out>{}</system-out>\n    </testcase>\n", found);
  }
  if (outcome == "unusable") {
    return head + fmt::format(">\n      <error message=\"{}\"/>\n    </testcase>\n", found);
  }
  if (outcome == "skipped") {
    return head + fmt::format(">\n      <skipped message=\"{}\"/>\n    </testcase>\n", found);
  }
  return head + fmt::format(">\n      <failure message=\"{}\">{}</failure>\n    </testcase>\n",
                            outcome, found);
}

/// A suite of test cases, counted.
struct Cases {
  std::string text;
  std::ptrdiff_t all = 0, failed = 0, unusable = 0, skipped = 0;

  void add(const std::string& suite, const std::string& name, std::string_view outcome,
           const std::string& found) {
    text += audit_case(suite, name, outcome, found);
    ++all;
    unusable += outcome == "unusable";
    skipped += outcome == "skipped";
    failed += outcome != "unusable" && outcome != "clear" && outcome != "skipped";
  }
};

void add_road(const std::string& suite, const AuditedDrive& audited, Cases& cases) {
  const RoadAudit& road = *audited.road;
  cases.add(suite, fmt::format("{}: on {}", audited.name, road.on),
            planning::to_string(road.surface.verdict), surface_text(road));
  for (const planning::RuleReport& rule : road.rules) {
    const bool counts = std::ranges::count(road.counted, rule.rule) > 0;
    // What the map does not say is no failure, unless it was asked for.
    const bool is_skipped = rule.verdict == planning::Verdict::unknown && !counts;
    cases.add(suite, fmt::format("{}: {}", audited.name, planning::to_string(rule.rule)),
              is_skipped ? "skipped" : planning::to_string(rule.verdict), rule_text(rule, counts));
  }
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

// The outlines of all parts where they are farthest out, and the point that is.
void add_excursion(Json& features, const AuditedDrive& audited, const planning::Excursion& out,
                   const std::vector<geometry::BodyPart>& parts) {
  const Json about = {
      {"drive", audited.name},  {"kind", "excursion"}, {"from_s", out.from_s},
      {"to_s", out.to_s},       {"at_s", out.at.t_s},  {"margin_m", out.least_margin_m},
      {"depth_m", out.depth_m}, {"part", out.part},    {"onto", planning::text_of(out.onto)}};
  features.push_back(feature(outlines(parts, out.at.pose()), about));
  Json place = about;
  place["kind"] = "excursion point";
  features.push_back(feature({{"type", "Point"}, {"coordinates", position(out.point_in_source)}},
                             std::move(place)));
}

}  // namespace

std::string audits_junit(const std::vector<AuditedDrive>& audits, const std::string& name) {
  Cases cases;
  for (const AuditedDrive& audited : audits) {
    const bool is_usable = audited.fault.empty();
    cases.add(name, audited.name, audited.outcome(),
              is_usable ? audit_text(audited) : audited.fault);
    if (is_usable && audited.road) add_road(name, audited, cases);
  }
  return fmt::format(
      "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<testsuites>\n"
      "  <testsuite name=\"roadbed audit {}\" tests=\"{}\" failures=\"{}\" errors=\"{}\"{}>\n"
      "{}  </testsuite>\n</testsuites>\n",
      map::html_text(name), cases.all, cases.failed, cases.unusable,
      cases.skipped > 0 ? fmt::format(" skipped=\"{}\"", cases.skipped) : "", cases.text);
}

std::string audits_geojson(const std::vector<AuditedDrive>& audits,
                           const planning::AuditQuestion& question, const std::string& crs) {
  const std::vector<geometry::BodyPart> parts = question.inflated_parts();
  Json features = Json::array();
  for (const AuditedDrive& audited : audits) {
    if (!audited.fault.empty()) continue;
    const geometry::Trajectory& drive = audited.drive;
    for (const auto& stretch : judged_stretches(audited.whole(), drive.start_s(), drive.end_s())) {
      features.push_back(stretch_feature(audited, stretch));
    }
    if (audited.road) {
      for (const planning::Excursion& out : audited.road->surface.conflicts) {
        add_excursion(features, audited, out, parts);
      }
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

}  // namespace roadbed::tools::commands::audits
