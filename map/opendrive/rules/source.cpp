#include "roadbed/map/opendrive/rules/source.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <set>
#include <stdexcept>

#include "roadbed/map/opendrive/values.h"

namespace roadbed::map::opendrive::rules {
namespace {

CurveSource curve_source(const GeometryRecord& record) {
  CurveSource made{record, {}, {}};
  if (!record.piece) return made;
  try {
    const geometry::PlanView view({*record.piece});
    made.start = view.at(record.s_m);
    made.end = view.at(record.s_m + record.length_m);
  } catch (const std::invalid_argument&) {
    made.start.reset();  // a curve that cannot be evaluated
  }
  return made;
}

RoadSource road_source(const RoadRecord& record) {
  RoadSource road{record, {}};
  for (const GeometryRecord& geometry : record.geometry) {
    road.geometry.push_back(curve_source(geometry));
  }
  return road;
}

std::string element_name(const char* kind, pugi::xml_node node) {
  return fmt::format("{} {}", kind, node.attribute("id").value());
}

/// "12" of "road 12" and of "lane 12/0/-1".
std::string road_of(const std::string& element) {
  const std::size_t from = element.find(' ') + 1;
  return element.substr(from, element.find('/', from) - from);
}

bool is_about_links(const validation::Finding& finding) {
  return finding.rule.starts_with("link.") || finding.rule.starts_with("id.dangling") ||
         finding.rule.starts_with("junction.");
}

}  // namespace

std::optional<Eigen::Vector2d> RoadSource::place() const {
  if (geometry.empty() || !geometry.front().start) return {};
  return geometry.front().start->pose.position();
}

std::optional<Eigen::Vector2d> RoadSource::place_at(double s_m) const {
  const auto after =
      std::upper_bound(geometry.begin(), geometry.end(), s_m,
                       [](double s, const CurveSource& curve) { return s < curve.record.s_m; });
  if (after == geometry.begin() || !std::prev(after)->start) return place();
  return geometry::PlanView({*std::prev(after)->record.piece}).at(s_m).pose.position();
}

double RoadSource::end_s_m(const LaneSection& section) const {
  const LaneSection* next = &section + 1;
  return next == record.sections.data() + record.sections.size() ? record.length_m : next->s_m;
}

Source::Source(const XmlDocument& tree, const Document& judged) : xml(tree), document(judged) {
  roads.reserve(document.roads.size());
  for (const RoadRecord& road : document.roads) roads.push_back(road_source(road));
  for (const RoadSource& road : roads) road_by_id.emplace(road.record.id, &road);
  for (const JunctionRecord& junction : document.junctions) {
    junction_by_id.emplace(junction.id, &junction);
  }
  schema_faults = find_schema_faults(xml);
}

const RoadSource* Source::find_road(std::string_view id) const {
  const auto found = road_by_id.find(id);
  return found == road_by_id.end() ? nullptr : found->second;
}

bool Source::is_since(int minor) const {
  const auto header = xml.root().child("header");
  const auto major = xml.optional_integer(header, "revMajor");
  const auto found = xml.optional_integer(header, "revMinor");
  return !major || !found || *major != 1 || *found >= minor;
}

double Source::number(pugi::xml_node node, const char* attribute) const {
  return xml.optional_number(node, attribute).value_or(std::numeric_limits<double>::quiet_NaN());
}

std::vector<CubicElement> whole(const std::vector<CubicElement>& listed) {
  std::vector<CubicElement> kept;
  for (const CubicElement& element : listed) {
    const auto& [s_m, a, b, c, d] = element.record;
    if (!std::isnan(s_m + a + b + c + d)) kept.push_back(element);
  }
  sort_by_station(kept);
  return kept;
}

std::string lane_element(const RoadSource& road, const LaneSection& section, int lane) {
  return fmt::format("lane {}/{}/{}", road.record.id, &section - road.record.sections.data(), lane);
}

validation::Finding& add_at(validation::Report& report, const Source& source,
                            const RoadSource& road, pugi::xml_node node, std::string message) {
  validation::Finding& finding = report.add(road.element(), road.place(), std::move(message));
  finding.line = source.xml.line_of(node);
  return finding;
}

validation::ElementLines element_lines(const XmlDocument& xml, const Document& document) {
  validation::ElementLines lines;
  for (const RoadRecord& road : document.roads) {
    lines.emplace("road " + road.id, xml.line_of(road.node));
    for (std::size_t i = 0; i < road.sections.size(); ++i) {
      for (const LaneRecord& lane : road.sections[i].listed()) {
        if (std::string_view(lane.side) == "center") continue;
        lines.emplace(fmt::format("lane {}/{}/{}", road.id, i, lane.id), lane.line);
      }
    }
    for (const SignalRecord& signal : road.signals) {
      lines.emplace(element_name("signal", signal.node), xml.line_of(signal.node));
    }
    for (const ObjectRecord& object : road.objects) {
      lines.emplace(element_name("object", object.node), xml.line_of(object.node));
    }
  }
  for (const JunctionRecord& junction : document.junctions) {
    lines.emplace("junction " + junction.id, xml.line_of(junction.node));
  }
  for (const auto controller : xml.root().children("controller")) {
    lines.emplace(element_name("controller", controller), xml.line_of(controller));
  }
  return lines;
}

void mark_told(std::vector<ImportDiagnostic>& remarks,
               const std::vector<validation::Finding>& findings) {
  std::set<long> lines;
  std::set<std::string> badly_linked;
  for (const validation::Finding& finding : findings) {
    // What the program does without is nothing that the reader remarks.
    if (finding.rule != "schema.incomplete") lines.insert(finding.line);
    if (is_about_links(finding)) badly_linked.insert(road_of(finding.element));
  }
  for (ImportDiagnostic& remark : remarks) {
    const bool same_line = remark.is_fault && remark.line > 0 && lines.contains(remark.line);
    const bool same_link =
        remark.rule == "import.link" && badly_linked.contains(road_of(remark.element));
    remark.in_text = same_line || same_link;
  }
}

std::vector<validation::Finding> check(const XmlDocument& xml, const Document& document,
                                       const validation::ValidateOptions& options) {
  return validation::findings_of(source_rules(), Source(xml, document), options);
}

std::vector<SourceRule> source_rules() {
  std::vector<SourceRule> all;
  for (const auto rules :
       {schema_rules(), header_rules(), id_rules(), curve_rules(), record_rules(), profile_rules(),
        width_rules(), lane_rules(), linkage_rules(), lane_linkage_rules(), junction_rules(),
        redundancy_rules(), signal_rules(), signal_board_rules(), object_rules(),
        object_type_rules(), cross_section_rules()}) {
    all.insert(all.end(), rules.begin(), rules.end());
  }
  return all;
}

}  // namespace roadbed::map::opendrive::rules
