#include "roadbed/map/lanelet2/rules/source.h"

#include <fmt/format.h>

#include <set>

#include "roadbed/map/lanelet2/traffic_rules.h"

namespace roadbed::map::lanelet2::rules {
namespace {

template <typename Element>
validation::Finding& add(validation::Report& report, const Source& source, const Element& element,
                         const char* kind, std::string message) {
  validation::Finding& finding =
      report.add(fmt::format("{} {}", kind, element.id), std::nullopt, std::move(message));
  finding.line = source.document.line_of(element.at);
  return finding;
}

}  // namespace

std::string_view Lanelet::tag(std::string_view key) const { return value_of(relation.tags, key); }

Source::Source(const Document& judged, const BuiltLanes& built) : document(judged) {
  for (const Relation& relation : document.relations) {
    if (relation.type == "lanelet") lanelets.push_back({relation, {}, {}});
    if (relation.type == "regulatory_element") regulations.push_back(&relation);
  }
  const auto edge = [&](std::size_t lane, auto node) {
    return Edge{node(document, built.left[lane]), node(document, built.right[lane])};
  };
  for (std::size_t lane = 0, i = 0; lane < built.lanes.size(); ++lane) {
    while (&lanelets[i].relation != &document.relations[built.relations[lane]]) ++i;
    lanelets[i].start = edge(lane, first_node);
    lanelets[i].end = edge(lane, last_node);
  }
}

std::optional<Eigen::Vector2d> Source::local_place(std::uint32_t node) const {
  const NodePlace& place = document.places[node];
  if (!place.is_local()) return {};
  return Eigen::Vector2d(place.local_x_m, place.local_y_m);
}

validation::Finding& add_at(validation::Report& report, const Source& source, const Node& node,
                            std::string message) {
  return add(report, source, node, "node", std::move(message));
}

validation::Finding& add_at(validation::Report& report, const Source& source, const Way& way,
                            std::string message) {
  return add(report, source, way, "way", std::move(message));
}

validation::Finding& add_at(validation::Report& report, const Source& source,
                            const Relation& relation, std::string message) {
  const bool regulation = relation.type == "regulatory_element";
  return add(report, source, relation, regulation ? "regulation" : "relation", std::move(message));
}

validation::Finding& add_at(validation::Report& report, const Source& source,
                            const Lanelet& lanelet, std::string message) {
  validation::Finding& finding = add(report, source, lanelet.relation, "lane", std::move(message));
  if (lanelet.start) finding.in_map = source.local_place(lanelet.start->left);
  return finding;
}

std::vector<const Lanelet*> lanelets_with_swapped_borders(const Source& source) {
  std::set<Edge> starts, ends;
  for (const Lanelet& lanelet : source.lanelets) {
    if (!lanelet.start) continue;
    starts.insert(*lanelet.start);
    ends.insert(*lanelet.end);
  }
  const auto crossed = [](const Edge& edge) { return Edge{edge.right, edge.left}; };
  const auto is_point = [](const Edge& edge) { return edge.left == edge.right; };
  std::vector<const Lanelet*> found;
  for (const Lanelet& lanelet : source.lanelets) {
    if (!lanelet.start || lanelet.tag("one_way") == "no") continue;
    const Edge &start = *lanelet.start, &end = *lanelet.end;
    const bool goes_on = starts.contains(end) || ends.contains(start);
    const bool collides = ends.contains(crossed(end)) && starts.contains(crossed(start));
    if (!goes_on && collides && !is_point(start) && !is_point(end)) found.push_back(&lanelet);
  }
  return found;
}

std::vector<SourceRule> source_rules() {
  std::vector<SourceRule> all;
  for (const auto rules : {element_rules(), lanelet_rules(), regulation_rules()}) {
    all.insert(all.end(), rules.begin(), rules.end());
  }
  return all;
}

std::vector<validation::Finding> check(const Document& document, const BuiltLanes& built,
                                       const validation::ValidateOptions& options) {
  return validation::findings_of(source_rules(), Source(document, built), options);
}

validation::ElementLines element_lines(const Document& document) {
  validation::ElementLines lines;
  for (const Relation& relation : document.relations) {
    const bool is_lanelet = relation.type == "lanelet";
    if (!is_lanelet && relation.type != "regulatory_element") continue;
    lines.emplace(fmt::format("{} {}", is_lanelet ? "lane" : "regulation", relation.id),
                  document.line_of(relation.at));
  }
  return lines;
}

}  // namespace roadbed::map::lanelet2::rules
