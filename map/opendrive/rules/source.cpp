#include "roadbed/map/opendrive/rules/source.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <iterator>
#include <limits>
#include <stdexcept>

namespace roadbed::map::opendrive::rules {
namespace {

constexpr double kBroken = std::numeric_limits<double>::quiet_NaN();

std::optional<int> whole_number(const char* text) {
  const std::string_view written = text;
  int value = 0;
  const auto [end, error] = std::from_chars(written.data(), written.data() + written.size(), value);
  if (error != std::errc() || end != written.data() + written.size()) return {};
  return value;
}

std::vector<int> ids_of(pugi::xml_node link, const char* name) {
  std::vector<int> ids;
  for (const auto node : link.children(name)) {
    if (const auto id = whole_number(node.attribute("id").value())) ids.push_back(*id);
  }
  return ids;
}

class Reading {
 public:
  explicit Reading(const Source& source) : source_(source) {}

  RoadSource road(pugi::xml_node node) const {
    RoadSource road{.node = node,
                    .id = node.attribute("id").value(),
                    .junction = node.attribute("junction").value(),
                    .length_m = source_.number(node, "length"),
                    .geometry = {},
                    .sections = {}};
    if (road.junction == "-1") road.junction.clear();
    for (const auto child : node.child("planView").children("geometry")) {
      road.geometry.push_back(geometry(child));
    }
    for (const auto child : node.child("lanes").children("laneSection")) {
      road.sections.push_back(section(child));
    }
    for (std::size_t i = 0; i < road.sections.size(); ++i) {
      const bool last = i + 1 == road.sections.size();
      road.sections[i].end_s_m = last ? road.length_m : road.sections[i + 1].s_m;
    }
    return road;
  }

 private:
  double number(pugi::xml_node node, const char* attribute) const {
    return source_.number(node, attribute);
  }

  std::optional<geometry::PlanCurve> curve(pugi::xml_node node, double length_m) const {
    if (node.child("line")) return geometry::LineCurve{};
    if (const auto arc = node.child("arc")) return geometry::ArcCurve{number(arc, "curvature")};
    if (const auto spiral = node.child("spiral")) {
      return geometry::SpiralCurve{number(spiral, "curvStart"), number(spiral, "curvEnd")};
    }
    if (const auto poly = node.child("poly3")) {
      return geometry::Poly3Curve{number(poly, "a"), number(poly, "b"), number(poly, "c"),
                                  number(poly, "d")};
    }
    const auto poly = node.child("paramPoly3");
    if (!poly) return {};
    const bool by_length = std::string_view(poly.attribute("pRange").value()) == "arcLength";
    return geometry::ParamPoly3Curve{
        {number(poly, "aU"), number(poly, "bU"), number(poly, "cU"), number(poly, "dU")},
        {number(poly, "aV"), number(poly, "bV"), number(poly, "cV"), number(poly, "dV")},
        by_length ? length_m : 1.0};
  }

  // Turning more than this often is a slip of a number, and slow to evaluate.
  static bool is_sane(const geometry::PlanPiece& piece) {
    constexpr double kMostTurningRad = 1000.0;
    double curvature = 0.0;
    if (const auto* arc = std::get_if<geometry::ArcCurve>(&piece.curve)) {
      curvature = std::abs(arc->curvature_per_m);
    } else if (const auto* spiral = std::get_if<geometry::SpiralCurve>(&piece.curve)) {
      curvature =
          std::max(std::abs(spiral->start_curvature_per_m), std::abs(spiral->end_curvature_per_m));
    }
    return curvature * piece.length_m < kMostTurningRad && piece.length_m > 0.0;
  }

  GeometrySource geometry(pugi::xml_node node) const {
    GeometrySource made{.node = node,
                        .s_m = number(node, "s"),
                        .length_m = number(node, "length"),
                        .piece = {},
                        .start = {},
                        .end = {}};
    const auto shape = curve(node, made.length_m);
    if (!shape) return made;
    const geometry::PlanPiece piece{made.s_m,
                                    made.length_m,
                                    {number(node, "x"), number(node, "y"), number(node, "hdg")},
                                    *shape};
    if (!is_sane(piece)) return made;
    try {
      const geometry::PlanView view({piece});
      made.start = view.at(made.s_m);
      made.end = view.at(made.s_m + made.length_m);
      made.piece = piece;
    } catch (const std::invalid_argument&) {
      return made;  // a broken number, which the rules about the schema name
    }
    return made;
  }

  SectionSource section(pugi::xml_node node) const {
    SectionSource section{
        .node = node, .s_m = number(node, "s"), .end_s_m = 0.0, .lanes = {}, .by_id = {}};
    for (const std::string_view side : {"left", "center", "right"}) {
      for (const auto lane : node.child(side.data()).children("lane")) {
        const auto id = whole_number(lane.attribute("id").value());
        if (!id) continue;
        section.by_id.emplace_back(*id, section.lanes.size());
        section.lanes.push_back({lane, side, *id, ids_of(lane.child("link"), "predecessor"),
                                 ids_of(lane.child("link"), "successor")});
      }
    }
    std::sort(section.by_id.begin(), section.by_id.end());
    return section;
  }

  const Source& source_;
};

}  // namespace

const LaneSource* SectionSource::find(int id) const {
  const auto found = std::lower_bound(by_id.begin(), by_id.end(), std::pair(id, std::size_t{0}));
  return found == by_id.end() || found->first != id ? nullptr : &lanes[found->second];
}

std::optional<Eigen::Vector2d> RoadSource::place() const {
  if (geometry.empty() || !geometry.front().start) return {};
  return geometry.front().start->pose.position();
}

std::optional<Eigen::Vector2d> RoadSource::place_at(double s_m) const {
  const auto after =
      std::upper_bound(geometry.begin(), geometry.end(), s_m,
                       [](double s, const GeometrySource& piece) { return s < piece.s_m; });
  if (after == geometry.begin() || !std::prev(after)->piece) return place();
  return geometry::PlanView({*std::prev(after)->piece}).at(s_m).pose.position();
}

Source::Source(const XmlDocument& document) : xml(document) {
  const Reading reading(*this);
  for (const auto node : xml.root().children("road")) roads.push_back(reading.road(node));
  for (const RoadSource& road : roads) road_by_id.emplace(road.id, &road);
  for (const auto node : xml.root().children("junction")) {
    junctions.push_back(node);
    junction_by_id.emplace(node.attribute("id").value(), node);
  }
  schema_faults = find_schema_faults(xml);
}

const RoadSource* Source::find_road(std::string_view id) const {
  const auto found = road_by_id.find(id);
  return found == road_by_id.end() ? nullptr : found->second;
}

double Source::number(pugi::xml_node node, const char* attribute) const {
  return xml.optional_number(node, attribute).value_or(kBroken);
}

std::vector<CubicSource> Source::cubics(pugi::xml_node parent, const char* name,
                                        const char* s_attribute, double s_add_m) const {
  std::vector<CubicSource> list;
  for (const auto node : parent.children(name)) {
    const geometry::CubicRecord record{number(node, s_attribute) + s_add_m, number(node, "a"),
                                       number(node, "b"), number(node, "c"), number(node, "d")};
    if (std::isnan(record.s_m + record.a + record.b + record.c + record.d)) continue;
    list.push_back({node, record});
  }
  return list;
}

std::string lane_element(const RoadSource& road, const SectionSource& section, int lane) {
  return fmt::format("lane {}/{}/{}", road.id, &section - road.sections.data(), lane);
}

validation::Finding& add_at(validation::Report& report, const Source& source,
                            const RoadSource& road, pugi::xml_node node, std::string message) {
  validation::Finding& finding = report.add(road.element(), road.place(), std::move(message));
  finding.line = source.xml.line_of(node);
  return finding;
}

validation::ElementLines element_lines(const XmlDocument& xml) {
  validation::ElementLines lines;
  for (const auto road : xml.root().children("road")) {
    const std::string id = road.attribute("id").value();
    lines.emplace("road " + id, xml.line_of(road));
    int section_index = 0;
    for (const auto section : road.child("lanes").children("laneSection")) {
      for (const char* side : {"left", "right"}) {
        for (const auto lane : section.child(side).children("lane")) {
          lines.emplace(
              fmt::format("lane {}/{}/{}", id, section_index, lane.attribute("id").value()),
              xml.line_of(lane));
        }
      }
      ++section_index;
    }
    for (const char* kind : {"signal", "object"}) {
      for (const auto node :
           road.child(kind == std::string_view("signal") ? "signals" : "objects").children(kind)) {
        lines.emplace(fmt::format("{} {}", kind, node.attribute("id").value()), xml.line_of(node));
      }
    }
  }
  for (const char* kind : {"junction", "controller"}) {
    for (const auto node : xml.root().children(kind)) {
      lines.emplace(fmt::format("{} {}", kind, node.attribute("id").value()), xml.line_of(node));
    }
  }
  return lines;
}

std::vector<SourceRule> source_rules() {
  std::vector<SourceRule> all;
  for (const auto rules :
       {schema_rules(), header_rules(), id_rules(), curve_rules(), profile_rules(), lane_rules(),
        linkage_rules(), junction_rules(), redundancy_rules(), signal_rules()}) {
    all.insert(all.end(), rules.begin(), rules.end());
  }
  return all;
}

}  // namespace roadbed::map::opendrive::rules
