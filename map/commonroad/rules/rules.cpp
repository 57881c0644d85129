#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <set>
#include <unordered_set>

#include "roadbed/map/commonroad/rules/source.h"

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

validation::Finding& add(validation::Report& report, const Source& source, pugi::xml_node node,
                         std::string message) {
  validation::Finding& finding = report.add(element_of(node), place_of(node), std::move(message));
  finding.line = source.xml.line_of(node);
  return finding;
}

template <typename Check>
void for_each_lanelet(const Source& source, const Check& check) {
  for (const auto lanelet : source.xml.root().children("lanelet")) check(lanelet);
}

void unknown_versions(const Source& source, const validation::ValidateOptions&,
                      validation::Report& report) {
  const std::string_view version = source.xml.root().attribute("commonRoadVersion").value();
  if (version == "2018b" || version == "2020a") return;
  report
      .add("file", std::nullopt,
           fmt::format("commonRoadVersion=\"{}\" is not 2018b or 2020a; convert the file or "
                       "correct it",
                       version))
      .line = source.xml.line_of(source.xml.root());
}

void duplicate_ids(const Source& source, const validation::ValidateOptions&,
                   validation::Report& report) {
  std::unordered_map<std::string_view, long> seen;
  for (const auto node : source.xml.root().children()) {
    if (!node.attribute("id")) continue;
    const auto [first, is_new] = seen.emplace(id_of(node), source.xml.line_of(node));
    if (is_new) continue;
    add(report, source, node,
        fmt::format("has the id of the element in line {}; ids must differ in the whole file",
                    first->second));
  }
}

void dangling_references(const Source& source, const validation::ValidateOptions&,
                         validation::Report& report) {
  struct Reference {
    const char* name;
    const ById& targets;
  };
  const Reference references[] = {
      {"predecessor", source.lanelets},  {"successor", source.lanelets},
      {"adjacentLeft", source.lanelets}, {"adjacentRight", source.lanelets},
      {"trafficSignRef", source.signs},  {"trafficLightRef", source.lights},
  };
  for_each_lanelet(source, [&](pugi::xml_node lanelet) {
    for (const auto& [name, targets] : references) {
      for (const auto reference : lanelet.children(name)) {
        if (targets.contains(reference.attribute("ref").value())) continue;
        add(report, source, lanelet,
            fmt::format("its {} {} is not in the file; add or remove it", name,
                        reference.attribute("ref").value()));
      }
    }
  });
}

bool refers(pugi::xml_node from, const char* name, std::string_view to) {
  const auto references = from.children(name);
  return std::any_of(references.begin(), references.end(), [&](pugi::xml_node reference) {
    return to == reference.attribute("ref").value();
  });
}

void one_sided_successors(const Source& source, const validation::ValidateOptions&,
                          validation::Report& report) {
  for_each_lanelet(source, [&](pugi::xml_node lanelet) {
    for (const auto& [name, back] :
         {std::pair{"successor", "predecessor"}, {"predecessor", "successor"}}) {
      for (const auto reference : lanelet.children(name)) {
        const auto other = source.lanelets.find(reference.attribute("ref").value());
        if (other == source.lanelets.end() || refers(other->second, back, id_of(lanelet))) continue;
        add(report, source, lanelet,
            fmt::format("its {} {} does not name it as {}; make both name each other", name,
                        other->first, back));
      }
    }
  });
}

/// The adjacency that should answer another one.
const char* answer(std::string_view name, bool same) {
  return (name == "adjacentLeft") == same ? "adjacentRight" : "adjacentLeft";
}

bool same_direction(pugi::xml_node adjacency) {
  return std::string_view(adjacency.attribute("drivingDir").value()) == "same";
}

void one_sided_adjacencies(const Source& source, const validation::ValidateOptions&,
                           validation::Report& report) {
  for_each_lanelet(source, [&](pugi::xml_node lanelet) {
    for (const char* name : {"adjacentLeft", "adjacentRight"}) {
      const auto adjacency = lanelet.child(name);
      const auto other = source.lanelets.find(adjacency.attribute("ref").value());
      if (!adjacency || other == source.lanelets.end()) continue;
      const auto back = other->second.child(answer(name, same_direction(adjacency)));
      if (std::string_view(back.attribute("ref").value()) == id_of(lanelet) &&
          same_direction(back) == same_direction(adjacency)) {
        continue;
      }
      add(report, source, lanelet,
          fmt::format("its {} {} ({}) does not name it as {}; make both name each other", name,
                      other->first, same_direction(adjacency) ? "same" : "opposite",
                      answer(name, same_direction(adjacency))));
    }
  });
}

long count_points(pugi::xml_node bound) {
  const auto points = bound.children("point");
  return std::distance(points.begin(), points.end());
}

void uneven_borders(const Source& source, const validation::ValidateOptions&,
                    validation::Report& report) {
  for_each_lanelet(source, [&](pugi::xml_node lanelet) {
    const long left = count_points(lanelet.child("leftBound"));
    const long right = count_points(lanelet.child("rightBound"));
    if (left == right && left >= 2) return;
    add(report, source, lanelet,
        fmt::format("its left bound has {} points and its right one {}; it needs two or more of "
                    "each, as many on both sides",
                    left, right));
  });
}

void stop_lines_without_reference(const Source& source, const validation::ValidateOptions&,
                                  validation::Report& report) {
  for_each_lanelet(source, [&](pugi::xml_node lanelet) {
    const auto line = lanelet.child("stopLine");
    if (!line) return;
    const bool lanes_own = line.child("trafficSignRef") || line.child("trafficLightRef") ||
                           lanelet.child("trafficSignRef") || lanelet.child("trafficLightRef");
    if (lanes_own) return;
    add(report, source, lanelet,
        "its stop line has no traffic sign or light that says when to stop; refer to one");
  });
}

void dangling_stop_lines(const Source& source, const validation::ValidateOptions&,
                         validation::Report& report) {
  for_each_lanelet(source, [&](pugi::xml_node lanelet) {
    const auto line = lanelet.child("stopLine");
    for (const auto& [name, targets] :
         {std::pair{"trafficSignRef", &source.signs}, {"trafficLightRef", &source.lights}}) {
      for (const auto reference : line.children(name)) {
        if (targets->contains(reference.attribute("ref").value())) continue;
        add(report, source, lanelet,
            fmt::format("the {} {} of its stop line is not in the file; add or remove it", name,
                        reference.attribute("ref").value()));
      }
    }
  });
}

void unused_signs(const Source& source, const validation::ValidateOptions&,
                  validation::Report& report) {
  std::unordered_set<std::string_view> used;
  const auto use = [&](pugi::xml_node holder) {
    for (const char* name : {"trafficSignRef", "trafficLightRef"}) {
      for (const auto reference : holder.children(name)) {
        used.insert(reference.attribute("ref").value());
      }
    }
  };
  for_each_lanelet(source, [&](pugi::xml_node lanelet) {
    use(lanelet);
    use(lanelet.child("stopLine"));
  });
  for (const char* kind : {"trafficSign", "trafficLight"}) {
    for (const auto sign : source.xml.root().children(kind)) {
      if (used.contains(id_of(sign))) continue;
      add(report, source, sign, "no lanelet refers to it, so that it holds for nobody; add it");
    }
  }
}

void broken_intersections(const Source& source, const validation::ValidateOptions&,
                          validation::Report& report) {
  for (const auto intersection : source.xml.root().children("intersection")) {
    for (const auto incoming : intersection.children("incoming")) {
      if (!incoming.child("incomingLanelet")) {
        add(report, source, intersection, "has an incoming without incomingLanelet; add one");
      }
      for (const char* name :
           {"incomingLanelet", "successorsRight", "successorsStraight", "successorsLeft"}) {
        for (const auto reference : incoming.children(name)) {
          if (source.lanelets.contains(reference.attribute("ref").value())) continue;
          add(report, source, intersection,
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

Source::Source(const XmlDocument& document) : xml(document) {
  for (const auto node : xml.root().children()) {
    const std::string_view kind = node.name();
    if (kind == "lanelet") lanelets.emplace(id_of(node), node);
    if (kind == "trafficSign") signs.emplace(id_of(node), node);
    if (kind == "trafficLight") lights.emplace(id_of(node), node);
  }
}

std::span<const SourceRule> source_rules() { return kSourceRules; }

validation::ElementLines element_lines(const XmlDocument& xml) {
  validation::ElementLines lines;
  for (const auto node : xml.root().children()) {
    if (node.attribute("id")) lines.emplace(element_of(node), xml.line_of(node));
  }
  return lines;
}

}  // namespace roadbed::map::commonroad::rules
