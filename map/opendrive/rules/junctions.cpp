#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <map>
#include <set>

#include "roadbed/map/opendrive/rules/source.h"

namespace roadbed::map::opendrive::rules {
namespace {

/// <connection> of a junction, with the roads that it names, where they are there.
struct Connection {
  pugi::xml_node junction, node;
  const RoadSource *incoming = nullptr, *connecting = nullptr;  ///< connecting or linked
  bool at_end = false;                                          ///< contactPoint="end"

  std::string_view junction_id() const { return junction.attribute("id").value(); }
  std::string_view type() const { return junction.attribute("type").value(); }
};

template <typename Check>
void for_each_connection(const Source& source, const Check& check) {
  for (const auto junction : source.junctions) {
    for (const auto node : junction.children("connection")) {
      const auto via = node.attribute("connectingRoad") ? node.attribute("connectingRoad")
                                                        : node.attribute("linkedRoad");
      check(Connection{junction, node, source.find_road(node.attribute("incomingRoad").value()),
                       source.find_road(via.value()),
                       std::string_view(node.attribute("contactPoint").value()) == "end"});
    }
  }
}

validation::Finding& add(validation::Report& report, const Source& source,
                         const Connection& connection, std::string message) {
  validation::Finding& finding = report.add(
      fmt::format("junction {}", connection.junction_id()),
      connection.connecting ? connection.connecting->place() : std::nullopt, std::move(message));
  finding.line = source.xml.line_of(connection.node);
  return finding;
}

const char* id_of(const Connection& connection) { return connection.node.attribute("id").value(); }

bool has_link(const RoadSource& road, const char* end, const char* type, std::string_view id) {
  const auto link = road.node.child("link").child(end);
  return link && std::strcmp(link.attribute("elementType").value(), type) == 0 &&
         link.attribute("elementId").value() == id;
}

void connections_without_lanes(const Source& source, const validation::ValidateOptions&,
                               validation::Report& report) {
  for_each_connection(source, [&](const Connection& connection) {
    if (connection.node.child("laneLink") || connection.type() == "virtual") return;
    add(report, source, connection,
        fmt::format("connection {} has no laneLink, so that no lane leads over it; add them",
                    id_of(connection)));
  });
}

bool touches(const RoadSource& road, const Connection& connection) {
  if (has_link(road, "successor", "junction", connection.junction_id()) ||
      has_link(road, "predecessor", "junction", connection.junction_id())) {
    return true;
  }
  const RoadSource* via = connection.connecting;
  return via != nullptr && (has_link(*via, "predecessor", "road", road.id) ||
                            has_link(*via, "successor", "road", road.id));
}

void incoming_roads_elsewhere(const Source& source, const validation::ValidateOptions&,
                              validation::Report& report) {
  for_each_connection(source, [&](const Connection& connection) {
    if (connection.incoming == nullptr || connection.type() == "virtual") return;
    if (touches(*connection.incoming, connection)) return;
    add(report, source, connection,
        fmt::format("incoming road {} of connection {} has no end at this junction; link the road "
                    "to it or remove the connection",
                    connection.incoming->id, id_of(connection)));
  });
}

void connecting_roads_that_come_in(const Source& source, const validation::ValidateOptions&,
                                   validation::Report& report) {
  for_each_connection(source, [&](const Connection& connection) {
    if (connection.incoming == nullptr || connection.incoming->junction.empty()) return;
    if (connection.incoming->junction != connection.junction_id()) return;
    add(report, source, connection,
        fmt::format("incoming road {} of connection {} is itself a connecting road of the "
                    "junction; name the road outside of it",
                    connection.incoming->id, id_of(connection)));
  });
}

void double_connections(const Source& source, const validation::ValidateOptions&,
                        validation::Report& report) {
  std::set<std::tuple<std::string_view, const RoadSource*, const RoadSource*>> seen;
  for_each_connection(source, [&](const Connection& connection) {
    if (connection.incoming == nullptr || connection.connecting == nullptr) return;
    if (seen.emplace(connection.junction_id(), connection.incoming, connection.connecting).second) {
      return;
    }
    add(report, source, connection,
        fmt::format("connection {} is a second one from road {} to road {}; put its laneLinks into "
                    "the first",
                    id_of(connection), connection.incoming->id, connection.connecting->id));
  });
}

/// Whether the connecting road meets the incoming one with its other end.
bool meets_at_other_end(const Connection& connection) {
  if (connection.incoming == nullptr || connection.connecting == nullptr) return false;
  if (!connection.node.attribute("connectingRoad")) return false;
  const char* named = connection.at_end ? "successor" : "predecessor";
  const char* other = connection.at_end ? "predecessor" : "successor";
  return !has_link(*connection.connecting, named, "road", connection.incoming->id) &&
         has_link(*connection.connecting, other, "road", connection.incoming->id);
}

template <bool at_end>
void wrong_contact_points(const Source& source, const validation::ValidateOptions&,
                          validation::Report& report) {
  for_each_connection(source, [&](const Connection& connection) {
    if (connection.at_end != at_end || !meets_at_other_end(connection)) return;
    add(report, source, connection,
        fmt::format("connection {} says that road {} meets road {} at its {}, but it is linked to "
                    "it at its {}; correct contactPoint",
                    id_of(connection), connection.connecting->id, connection.incoming->id,
                    at_end ? "end" : "start", at_end ? "start" : "end"));
  });
}

void foreign_connecting_roads(const Source& source, const validation::ValidateOptions&,
                              validation::Report& report) {
  for_each_connection(source, [&](const Connection& connection) {
    if (connection.connecting == nullptr || !connection.node.attribute("connectingRoad")) return;
    if (connection.connecting->junction == connection.junction_id()) return;
    add(report, source, connection,
        fmt::format("connecting road {} says that it is in junction \"{}\"; correct its attribute "
                    "junction",
                    connection.connecting->id, connection.connecting->junction));
  });
}

void linked_roads(const Source& source, const validation::ValidateOptions&,
                  validation::Report& report) {
  for_each_connection(source, [&](const Connection& connection) {
    if (connection.type() == "direct" || !connection.node.attribute("linkedRoad")) return;
    add(report, source, connection,
        fmt::format("connection {} has a linkedRoad, which direct junctions only have; make it a "
                    "connectingRoad",
                    id_of(connection)));
  });
}

void connecting_roads(const Source& source, const validation::ValidateOptions&,
                      validation::Report& report) {
  for_each_connection(source, [&](const Connection& connection) {
    if (connection.type() != "direct" || !connection.node.attribute("connectingRoad")) return;
    add(report, source, connection,
        fmt::format("connection {} of a direct junction has a connectingRoad; make it a linkedRoad",
                    id_of(connection)));
  });
}

void empty_junctions(const Source& source, const validation::ValidateOptions&,
                     validation::Report& report) {
  for (const auto junction : source.junctions) {
    const std::string_view type = junction.attribute("type").value();
    if (junction.child("connection") || type == "crossing" || type == "virtual") continue;
    report
        .add(fmt::format("junction {}", junction.attribute("id").value()), std::nullopt,
             "has no connection; add them or remove it")
        .line = source.xml.line_of(junction);
  }
}

void unused_connecting_roads(const Source& source, const validation::ValidateOptions&,
                             validation::Report& report) {
  std::set<const RoadSource*> used;
  for_each_connection(source,
                      [&](const Connection& connection) { used.insert(connection.connecting); });
  for (const RoadSource& road : source.roads) {
    const auto junction = source.junction_by_id.find(road.junction);
    if (used.contains(&road) || junction == source.junction_by_id.end()) continue;
    const std::string_view type = junction->second.attribute("type").value();
    if (type == "crossing" || type == "virtual") continue;
    add_at(report, source, road, road.node,
           fmt::format("is in junction {}, but no connection of it leads over the road; add one or "
                       "remove the road",
                       road.junction));
  }
}

const SectionSource* touching_section(const RoadSource& road, bool at_end) {
  if (road.sections.empty()) return nullptr;
  return at_end ? &road.sections.back() : &road.sections.front();
}

void unknown_lanes(const Source& source, const validation::ValidateOptions&,
                   validation::Report& report) {
  for_each_connection(source, [&](const Connection& connection) {
    const RoadSource* via = connection.connecting;
    if (via == nullptr || !connection.node.attribute("connectingRoad")) return;
    const SectionSource* section = touching_section(*via, connection.at_end);
    if (section == nullptr || section->node.attribute("singleSide").as_bool()) return;
    for (const auto link : connection.node.children("laneLink")) {
      const int to = link.attribute("to").as_int();
      if (section->find(to) != nullptr) continue;
      add(report, source, connection,
          fmt::format("connection {} leads to lane {} of road {}, which is not there; correct it",
                      id_of(connection), to, via->id));
    }
  });
}

constexpr std::array<SourceRule, 12> kJunctionRules = {{
    {{"junction.no-lane-links",
      {},
      validation::Severity::warning,
      "a connection has no lane links"},
     connections_without_lanes},
    {{"junction.incoming-elsewhere",
      {},
      validation::Severity::error,
      "the incoming road of a connection does not touch its junction"},
     incoming_roads_elsewhere},
    {{"junction.connecting-comes-in",
      "asam.net:xodr:1.4.0:junctions.connection.connect_road_no_incoming_road",
      validation::Severity::error,
      "the incoming road of a connection is a connecting road of the same junction"},
     connecting_roads_that_come_in},
    {{"junction.double-connection", "asam.net:xodr:1.8.0:junctions.connection.one_link_to_incoming",
      validation::Severity::warning, "two connections lead from one road to one connecting road"},
     double_connections},
    {{"junction.contact-start", "asam.net:xodr:1.7.0:junctions.connection.start_along_linkage",
      validation::Severity::error,
      "a connecting road does not begin at the road that a connection says"},
     wrong_contact_points<false>},
    {{"junction.contact-end", "asam.net:xodr:1.7.0:junctions.connection.end_opposite_linkage",
      validation::Severity::error,
      "a connecting road does not end at the road that a connection says"},
     wrong_contact_points<true>},
    {{"junction.foreign-road",
      {},
      validation::Severity::warning,
      "a connecting road does not say that it is in the junction"},
     foreign_connecting_roads},
    {{"junction.linked-road", "asam.net:xodr:1.7.0:junctions.type_default_no_linked_road",
      validation::Severity::warning, "a junction that is not direct has a linked road"},
     linked_roads},
    {{"junction.connecting-road", "asam.net:xodr:1.7.0:junctions.type_direct_no_conn_road",
      validation::Severity::warning, "a direct junction has a connecting road"},
     connecting_roads},
    {{"junction.empty", {}, validation::Severity::warning, "a junction has no connections"},
     empty_junctions},
    {{"junction.unused-road",
      {},
      validation::Severity::warning,
      "no connection leads over a road of a junction"},
     unused_connecting_roads},
    {{"junction.unknown-lane", "asam.net:xodr:1.4.0:ids.only_ref_defined_ids",
      validation::Severity::error, "a connection leads to a lane that is not there"},
     unknown_lanes},
}};

}  // namespace

std::span<const SourceRule> junction_rules() { return kJunctionRules; }

}  // namespace roadbed::map::opendrive::rules
