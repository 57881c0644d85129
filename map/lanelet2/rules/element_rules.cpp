#include <fmt/format.h>

#include <array>

#include "roadbed/map/files/xml_scanner.h"
#include "roadbed/map/lanelet2/rules/source.h"

namespace roadbed::map::lanelet2::rules {
namespace {

template <typename Element>
void find_duplicates(const Source& source, const std::vector<Element>& elements,
                     const IdIndex& index, const char* kind, validation::Report& report) {
  for (const Element& element : elements) {
    const Element& first = elements[*index.find(element.id)];
    if (&first == &element) continue;
    add_at(report, source, element,
           fmt::format("has the id of the {} in line {}; give one of them another id", kind,
                       source.document.line_of(first.at)));
  }
}

void duplicate_ids(const Source& source, const validation::ValidateOptions&,
                   validation::Report& report) {
  const Document& document = source.document;
  if (document.node_index.repeated() > 0) {
    find_duplicates(source, document.nodes, document.node_index, "node", report);
  }
  find_duplicates(source, document.ways, document.way_index, "way", report);
  find_duplicates(source, document.relations, document.relation_index, "relation", report);
}

std::string_view name_of(MemberKind kind) {
  return kind == MemberKind::node ? "node" : kind == MemberKind::way ? "way" : "relation";
}

bool is_in_file(const Document& document, const Member& member) {
  const IdIndex& index = member.kind == MemberKind::node  ? document.node_index
                         : member.kind == MemberKind::way ? document.way_index
                                                          : document.relation_index;
  return index.find(member.id).has_value();
}

/// One finding for all references of an element that lead nowhere.
template <typename Element>
void add_dangling(const Source& source, const Element& element, const std::string& first,
                  std::size_t count, validation::Report& report) {
  const std::string more = count > 1 ? fmt::format(", like {} more", count - 1) : std::string();
  add_at(report, source, element,
         fmt::format("its {} is not in the file{}; add or remove it", first, more));
}

void dangling_members(const Source& source, const validation::ValidateOptions&,
                      validation::Report& report) {
  for (const Relation& relation : source.document.relations) {
    std::string first;
    std::size_t count = 0;
    for (const Member& member : relation.members) {
      if (is_in_file(source.document, member) || count++ > 0) continue;
      first = fmt::format("member \"{}\", {} {},", member.role, name_of(member.kind), member.id);
    }
    if (count > 0) add_dangling(source, relation, first, count, report);
  }
  for (const Way& way : source.document.ways) {
    if (way.missing == 0) continue;
    const std::string first = source.document.written_reference(way, way.first_missing);
    add_dangling(source, way, "node " + first, way.missing, report);
  }
}

void short_ways(const Source& source, const validation::ValidateOptions&,
                validation::Report& report) {
  for (const Way& way : source.document.ways) {
    if (way.references >= 2) continue;
    add_at(report, source, way, "has fewer than two nodes; add them or remove the way");
  }
}

void zero_coordinates(const Source& source, const validation::ValidateOptions&,
                      validation::Report& report) {
  std::size_t count = 0, first = 0;
  for (std::size_t i = 0; i < source.document.nodes.size(); ++i) {
    const NodePlace& place = source.document.places[i];
    if (place.latitude_deg != 0.0 || place.longitude_deg != 0.0 || place.is_local()) continue;
    if (count++ == 0) first = i;
  }
  if (count == 0) return;
  add_at(report, source, source.document.nodes[first],
         fmt::format("and {} more have latitude and longitude 0 and no local_x, local_y; give them "
                     "their place",
                     count - 1));
}

void broken_coordinates(const Source& source, const validation::ValidateOptions&,
                        validation::Report& report) {
  const Document& document = source.document;
  for (std::size_t i = 0; i < document.nodes.size(); ++i) {
    if (document.places[i].is_local() || document.places[i].is_on_earth()) continue;
    XmlScanner written(document.text, document.name, document.nodes[i].at);
    written.next();
    add_at(report, source, document.nodes[i],
           fmt::format("lat=\"{}\" lon=\"{}\" is no place on earth; correct it",
                       written.value("lat"), written.value("lon")));
  }
}

constexpr std::array<SourceRule, 5> kElementRules = {{
    {{"lanelet2.duplicate-id",
      {},
      validation::Severity::error,
      "two nodes, ways or relations have one id"},
     duplicate_ids},
    {{"lanelet2.dangling-member",
      {},
      validation::Severity::error,
      "a relation or way names an element that is not in the file"},
     dangling_members},
    {{"lanelet2.short-way", {}, validation::Severity::warning, "a way has fewer than two nodes"},
     short_ways},
    {{"lanelet2.zero-coordinates",
      {},
      validation::Severity::warning,
      "nodes have latitude and longitude 0 and no local coordinates"},
     zero_coordinates},
    {{"lanelet2.broken-coordinates",
      {},
      validation::Severity::error,
      "a node's coordinates are no place"},
     broken_coordinates},
}};

}  // namespace

std::span<const SourceRule> element_rules() { return kElementRules; }

}  // namespace roadbed::map::lanelet2::rules
