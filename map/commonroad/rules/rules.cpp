#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <set>
#include <unordered_set>

#include "roadbed/map/commonroad/rules/rules.h"

namespace roadbed::map::commonroad::rules {
namespace {

const char* id_of(pugi::xml_node node) { return node.attribute("id").value(); }

std::string element_of(pugi::xml_node node) {
  const std::string_view kind = node.name();
  return fmt::format("{} {}", kind == "lanelet" ? "lane" : kind, id_of(node));
}

std::optional<Eigen::Vector2d> place_of(pugi::xml_node lanelet) {
  const auto point = lanelet.child("leftBound").child("point");
  const double x = point.child("x").text().as_double(1e300);
  const double y = point.child("y").text().as_double(1e300);
  if (x > 1e299 || y > 1e299) return {};
  return Eigen::Vector2d(x, y);
}

validation::Finding& add(validation::Report& report, const Document& document, pugi::xml_node node,
                         std::string message) {
  validation::Finding& finding = report.add(element_of(node), place_of(node), std::move(message));
  finding.line = document.xml.line_of(node);
  return finding;
}

void unknown_versions(const Document& document, const validation::ValidateOptions&,
                      validation::Report& report) {
  const std::string_view version = document.xml.root().attribute("commonRoadVersion").value();
  if (version == "2018b" || version == "2020a") return;
  report
      .add("file", std::nullopt,
           fmt::format("commonRoadVersion=\"{}\" is not 2018b or 2020a; convert the file or "
                       "correct it",
                       version))
      .line = document.xml.line_of(document.xml.root());
}

void duplicate_ids(const Document& document, const validation::ValidateOptions&,
                   validation::Report& report) {
  std::unordered_map<std::string_view, long> seen;
  for (const auto node : document.xml.root().children()) {
    if (!node.attribute("id")) continue;
    const auto [first, is_new] = seen.emplace(id_of(node), document.xml.line_of(node));
    if (is_new) continue;
    add(report, document, node,
        fmt::format("has the id of the element in line {}; ids must differ in the whole file",
                    first->second));
  }
}

void dangling_references(const Document& document, const validation::ValidateOptions&,
                         validation::Report& report) {
  struct Reference {
    const char* name;
    const ElementsById& targets;
  };
  const Reference references[] = {
      {"predecessor", document.lanelet_by_id},  {"successor", document.lanelet_by_id},
      {"adjacentLeft", document.lanelet_by_id}, {"adjacentRight", document.lanelet_by_id},
      {"trafficSignRef", document.sign_by_id},  {"trafficLightRef", document.light_by_id},
  };
  for (const pugi::xml_node lanelet : document.lanelets()) {
    for (const auto& [name, targets] : references) {
      for (const auto reference : lanelet.children(name)) {
        if (targets.contains(reference.attribute("ref").value())) continue;
        add(report, document, lanelet,
            fmt::format("its {} {} is not in the file; add or remove it", name,
                        reference.attribute("ref").value()));
      }
    }
  }
}

void one_sided_successors(const Document& document, const validation::ValidateOptions&,
                          validation::Report& report) {
  for (const pugi::xml_node lanelet : document.lanelets()) {
    for (const char* name : {"successor", "predecessor"}) {
      for (const auto link : lanelet.children(name)) {
        const auto other = document.lanelet_by_id.find(link.attribute("ref").value());
        if (other == document.lanelet_by_id.end() || is_answered(lanelet, link, other->second)) {
          continue;
        }
        add(report, document, lanelet,
            fmt::format("its {} {} does not name it as {}; make both name each other", name,
                        other->first, counterpart(link)));
      }
    }
  }
}

void one_sided_adjacencies(const Document& document, const validation::ValidateOptions&,
                           validation::Report& report) {
  for (const pugi::xml_node lanelet : document.lanelets()) {
    for (const char* name : {"adjacentLeft", "adjacentRight"}) {
      const auto link = lanelet.child(name);
      const auto other = document.lanelet_by_id.find(link.attribute("ref").value());
      if (!link || other == document.lanelet_by_id.end() ||
          is_answered(lanelet, link, other->second)) {
        continue;
      }
      add(report, document, lanelet,
          fmt::format("its {} {} ({}) does not name it as {}; make both name each other", name,
                      other->first, is_same_direction(link) ? "same" : "opposite",
                      counterpart(link)));
    }
  }
}

long count_points(pugi::xml_node bound) {
  const auto points = bound.children("point");
  return std::distance(points.begin(), points.end());
}

void uneven_borders(const Document& document, const validation::ValidateOptions&,
                    validation::Report& report) {
  for (const pugi::xml_node lanelet : document.lanelets()) {
    const long left = count_points(lanelet.child("leftBound"));
    const long right = count_points(lanelet.child("rightBound"));
    if (left == right && left >= 2) continue;
    add(report, document, lanelet,
        fmt::format("its left bound has {} points and its right one {}; it needs two or more of "
                    "each, as many on both sides",
                    left, right));
  }
}

void stop_lines_without_reference(const Document& document, const validation::ValidateOptions&,
                                  validation::Report& report) {
  for (const pugi::xml_node lanelet : document.lanelets()) {
    const auto line = lanelet.child("stopLine");
    if (!line) continue;
    const bool lanes_own = line.child("trafficSignRef") || line.child("trafficLightRef") ||
                           lanelet.child("trafficSignRef") || lanelet.child("trafficLightRef");
    if (lanes_own) continue;
    add(report, document, lanelet,
        "its stop line has no traffic sign or light that says when to stop; refer to one");
  }
}

void dangling_stop_lines(const Document& document, const validation::ValidateOptions&,
                         validation::Report& report) {
  for (const pugi::xml_node lanelet : document.lanelets()) {
    const auto line = lanelet.child("stopLine");
    for (const auto& [name, targets] : {std::pair{"trafficSignRef", &document.sign_by_id},
                                        {"trafficLightRef", &document.light_by_id}}) {
      for (const auto reference : line.children(name)) {
        if (targets->contains(reference.attribute("ref").value())) continue;
        add(report, document, lanelet,
            fmt::format("the {} {} of its stop line is not in the file; add or remove it", name,
                        reference.attribute("ref").value()));
      }
    }
  }
}

void unused_signs(const Document& document, const validation::ValidateOptions&,
                  validation::Report& report) {
  std::unordered_set<std::string_view> used;
  const auto use = [&](pugi::xml_node holder) {
    for (const char* name : {"trafficSignRef", "trafficLightRef"}) {
      for (const auto reference : holder.children(name)) {
        used.insert(reference.attribute("ref").value());
      }
    }
  };
  for (const pugi::xml_node lanelet : document.lanelets()) {
    use(lanelet);
    use(lanelet.child("stopLine"));
  }
  for (const char* kind : {"trafficSign", "trafficLight"}) {
    for (const auto sign : document.xml.root().children(kind)) {
      if (used.contains(id_of(sign))) continue;
      add(report, document, sign, "no lanelet refers to it, so that it holds for nobody; add it");
    }
  }
}

void broken_intersections(const Document& document, const validation::ValidateOptions&,
                          validation::Report& report) {
  for (const auto intersection : document.xml.root().children("intersection")) {
    for (const auto incoming : intersection.children("incoming")) {
      if (!incoming.child("incomingLanelet")) {
        add(report, document, intersection, "has an incoming without incomingLanelet; add one");
      }
      for (const char* name :
           {"incomingLanelet", "successorsRight", "successorsStraight", "successorsLeft"}) {
        for (const auto reference : incoming.children(name)) {
          if (document.lanelet_by_id.contains(reference.attribute("ref").value())) continue;
          add(report, document, intersection,
              fmt::format("its {} {} is not in the file; add or remove it", name,
                          reference.attribute("ref").value()));
        }
      }
    }
  }
}

constexpr std::array<SourceRule, 10> kSourceRules = {{
    {{"common-road.version",
      {},
      validation::Severity::warning,
      "the file's version is not 2018b or 2020a"},
     unknown_versions},
    {{"common-road.duplicate-id", {}, validation::Severity::error, "two elements have one id"},
     duplicate_ids},
    {{"common-road.dangling-reference",
      {},
      validation::Severity::error,
      "a lanelet refers to an element that is not in the file"},
     dangling_references},
    {{"common-road.successor-one-sided",
      {},
      validation::Severity::warning,
      "a successor or predecessor does not name the lanelet back"},
     one_sided_successors},
    {{"common-road.adjacency-one-sided",
      {},
      validation::Severity::warning,
      "an adjacent lanelet does not name the lanelet back, in the same direction"},
     one_sided_adjacencies},
    {{"common-road.uneven-borders",
      {},
      validation::Severity::error,
      "a lanelet's bounds do not have as many points, or fewer than two"},
     uneven_borders},
    {{"common-road.stop-line-without-reference",
      {},
      validation::Severity::info,
      "a stop line has neither a sign nor a light"},
     stop_lines_without_reference},
    {{"common-road.dangling-stop-line",
      {},
      validation::Severity::error,
      "a stop line refers to a sign or light that is not in the file"},
     dangling_stop_lines},
    {{"common-road.unused-sign",
      {},
      validation::Severity::info,
      "no lanelet refers to a sign or light"},
     unused_signs},
    {{"common-road.intersection",
      {},
      validation::Severity::error,
      "an intersection names a lanelet that is not in the file, or none"},
     broken_intersections},
}};

}  // namespace

std::span<const SourceRule> source_rules() { return kSourceRules; }

std::vector<validation::Finding> check(const Document& document,
                                       const validation::ValidateOptions& options) {
  return validation::findings_of(source_rules(), document, options);
}

validation::ElementLines element_lines(const Document& document) {
  validation::ElementLines lines;
  for (const auto node : document.xml.root().children()) {
    if (node.attribute("id")) lines.emplace(element_of(node), document.xml.line_of(node));
  }
  return lines;
}

}  // namespace roadbed::map::commonroad::rules
