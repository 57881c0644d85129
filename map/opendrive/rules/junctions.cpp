#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <map>
#include <set>

#include "roadbed/map/opendrive/rules/lane_links.h"

namespace roadbed::map::opendrive::rules {
namespace {

/// <connection> of a junction, with the roads that it names, where they are there.
struct Connection {
  const JunctionRecord& junction;
  const JunctionConnection& record;
  const RoadSource *incoming = nullptr, *connecting = nullptr;  ///< connecting or linked

  bool at_end() const { return record.contact == ContactPoint::end; }
};

template <typename Check>
void for_each_connection(const Source& source, const Check& check) {
  for (const JunctionRecord& junction : source.document.junctions) {
    for (const JunctionConnection& record : junction.connections) {
      check(Connection{junction, record, source.find_road(record.incoming_road),
                       source.find_road(record.connecting_road)});
    }
  }
}

validation::Finding& add(validation::Report& report, const Connection& connection,
                         std::string message) {
  validation::Finding& finding = report.add(
      fmt::format("junction {}", connection.junction.id),
      connection.connecting ? connection.connecting->place() : std::nullopt, std::move(message));
  finding.line = connection.record.line;
  return finding;
}

const char* id_of(const Connection& connection) {
  return connection.record.node.attribute("id").value();
}

bool leads_to_road(const std::optional<RoadLink>& link, const RoadSource& road) {
  return link && !link->to_junction && link->element_id == road.record.id;
}

bool leads_to_junction(const std::optional<RoadLink>& link, const JunctionRecord& junction) {
  return link && link->to_junction && link->element_id == junction.id;
}

void connections_without_lanes(const Source& source, const validation::ValidateOptions&,
                               validation::Report& report) {
  for_each_connection(source, [&](const Connection& connection) {
    if (connection.record.node.child("laneLink") ||
        connection.junction.kind == JunctionKind::virtual_)
      return;
    add(report, connection,
        fmt::format("connection {} has no laneLink, so that no lane leads over it; add them",
                    id_of(connection)));
  });
}

bool touches(const RoadSource& road, const Connection& connection) {
  if (leads_to_junction(road.record.successor, connection.junction) ||
      leads_to_junction(road.record.predecessor, connection.junction)) {
    return true;
  }
  const RoadSource* via = connection.connecting;
  return via != nullptr && (leads_to_road(via->record.predecessor, road) ||
                            leads_to_road(via->record.successor, road));
}

void incoming_roads_elsewhere(const Source& source, const validation::ValidateOptions&,
                              validation::Report& report) {
  for_each_connection(source, [&](const Connection& connection) {
    if (connection.incoming == nullptr || connection.junction.kind == JunctionKind::virtual_)
      return;
    if (touches(*connection.incoming, connection)) return;
    add(report, connection,
        fmt::format("incoming road {} of connection {} has no end at this junction; link the road "
                    "to it or remove the connection",
                    connection.incoming->record.id, id_of(connection)));
  });
}

void connecting_roads_that_come_in(const Source& source, const validation::ValidateOptions&,
                                   validation::Report& report) {
  for_each_connection(source, [&](const Connection& connection) {
    if (connection.incoming == nullptr || connection.incoming->record.junction_id.empty()) return;
    const std::string& junction = connection.incoming->record.junction_id;
    add(report, connection,
        fmt::format("incoming road {} of connection {} is itself a connecting road of {}; name the "
                    "road outside of it",
                    connection.incoming->record.id, id_of(connection),
                    junction == connection.junction.id ? "the junction" : "junction " + junction));
  });
}

void double_connections(const Source& source, const validation::ValidateOptions&,
                        validation::Report& report) {
  std::set<std::tuple<std::string_view, const RoadSource*, const RoadSource*>> seen;
  for_each_connection(source, [&](const Connection& connection) {
    if (connection.incoming == nullptr || connection.connecting == nullptr) return;
    if (seen.emplace(connection.junction.id, connection.incoming, connection.connecting).second) {
      return;
    }
    add(report, connection,
        fmt::format("connection {} is a second one from road {} to road {}; put its laneLinks into "
                    "the first",
                    id_of(connection), connection.incoming->record.id,
                    connection.connecting->record.id));
  });
}

/// Where the connecting road is linked to instead of to the incoming one; empty if it is right, or
/// linked nowhere at all.
std::string wrong_link(const Connection& connection) {
  if (connection.incoming == nullptr || connection.connecting == nullptr) return {};
  if (connection.record.direct) return {};
  const RoadRecord& via = connection.connecting->record;
  const auto& named = connection.at_end() ? via.successor : via.predecessor;
  const auto& other = connection.at_end() ? via.predecessor : via.successor;
  if (leads_to_road(named, *connection.incoming)) return {};
  if (leads_to_road(other, *connection.incoming)) {
    return fmt::format("it is linked to it at its {}; correct contactPoint",
                       connection.at_end() ? "start" : "end");
  }
  if (!named || named->to_junction) return {};
  return fmt::format(
      "it is linked to road {} there; correct the link, contactPoint or incomingRoad",
      named->element_id);
}

template <bool at_end>
void wrong_contact_points(const Source& source, const validation::ValidateOptions&,
                          validation::Report& report) {
  for_each_connection(source, [&](const Connection& connection) {
    if (connection.at_end() != at_end) return;
    const std::string wrong = wrong_link(connection);
    if (wrong.empty()) return;
    add(report, connection,
        fmt::format("connection {} says that road {} meets road {} at its {}, but {}",
                    id_of(connection), connection.connecting->record.id,
                    connection.incoming->record.id, at_end ? "end" : "start", wrong));
  });
}

/// Whether a lane link leads from a lane that comes out of the junction, or to one that runs back:
/// the way of traffic from the incoming road into the connecting one is all that it stands for.
void outgoing_lane_links(const Source& source, const validation::ValidateOptions&,
                         validation::Report& report) {
  for_each_lane_link(source, [&](const LaneLink& link) {
    if (link.kind != LaneLink::Kind::in_junction || !is_drivable(link.from.lane->type)) return;
    if (link.from.drives_towards() && link.to.drives_away()) return;
    validation::Finding& finding =
        add_at(report, source, *link.to.road, link.node,
               fmt::format("connection {} links lane {} of road {} to lane {} of road {}, but {} "
                           "runs the other way; remove the laneLink",
                           link.node.attribute("id").value(), link.from.lane->id,
                           link.from.road->record.id, link.to.lane->id, link.to.road->record.id,
                           link.from.drives_towards() ? "the latter" : "the former"));
    finding.element = fmt::format("junction {}", link.node.parent().attribute("id").value());
    finding.in_map = link.to.road->place_at(link.to.s_m());
  });
}

void incomplete_priorities(const Source& source, const validation::ValidateOptions&,
                           validation::Report& report) {
  for (const JunctionRecord& junction : source.document.junctions) {
    for (const auto priority : junction.node.children("priority")) {
      const bool has_high = *priority.attribute("high").value() != '\0';
      const bool has_low = *priority.attribute("low").value() != '\0';
      if (has_high && has_low) continue;
      report
          .add(fmt::format("junction {}", junction.id), std::nullopt,
               fmt::format("a <priority> names no road with {} priority; name one of each",
                           has_high ? "low" : "high"))
          .line = source.xml.line_of(priority);
    }
  }
}

void foreign_connecting_roads(const Source& source, const validation::ValidateOptions&,
                              validation::Report& report) {
  for_each_connection(source, [&](const Connection& connection) {
    if (connection.connecting == nullptr || connection.record.direct) return;
    if (connection.connecting->record.junction_id == connection.junction.id) return;
    add(report, connection,
        fmt::format("connecting road {} says that it is in junction \"{}\"; correct its attribute "
                    "junction",
                    connection.connecting->record.id, connection.connecting->record.junction_id));
  });
}

void linked_roads(const Source& source, const validation::ValidateOptions&,
                  validation::Report& report) {
  for_each_connection(source, [&](const Connection& connection) {
    if (connection.junction.kind == JunctionKind::direct ||
        !connection.record.node.attribute("linkedRoad"))
      return;
    add(report, connection,
        fmt::format("connection {} has a linkedRoad, which direct junctions only have; make it a "
                    "connectingRoad",
                    id_of(connection)));
  });
}

void connecting_roads(const Source& source, const validation::ValidateOptions&,
                      validation::Report& report) {
  for_each_connection(source, [&](const Connection& connection) {
    if (connection.junction.kind != JunctionKind::direct || connection.record.direct) return;
    add(report, connection,
        fmt::format("connection {} of a direct junction has a connectingRoad; make it a linkedRoad",
                    id_of(connection)));
  });
}

bool needs_no_connection(const JunctionRecord& junction) {
  return junction.kind == JunctionKind::crossing || junction.kind == JunctionKind::virtual_;
}

void empty_junctions(const Source& source, const validation::ValidateOptions&,
                     validation::Report& report) {
  for (const JunctionRecord& junction : source.document.junctions) {
    if (!junction.connections.empty() || needs_no_connection(junction)) continue;
    report
        .add(fmt::format("junction {}", junction.id), std::nullopt,
             "has no connection; add them or remove it")
        .line = source.xml.line_of(junction.node);
  }
}

/// What leads to it may have been cut off with the rest of the map (map/edit).
bool is_part_of_clip(const RoadSource& road) {
  return !road.record.node.find_child_by_attribute("userData", "code", "roadbed.clip").empty();
}

void unused_connecting_roads(const Source& source, const validation::ValidateOptions&,
                             validation::Report& report) {
  std::set<const RoadSource*> used;
  for_each_connection(source,
                      [&](const Connection& connection) { used.insert(connection.connecting); });
  for (const RoadSource& road : source.roads) {
    const auto junction = source.junction_by_id.find(road.record.junction_id);
    if (used.contains(&road) || junction == source.junction_by_id.end()) continue;
    if (needs_no_connection(*junction->second) || is_part_of_clip(road)) continue;
    add_at(report, source, road, road.record.node,
           fmt::format("is in junction {}, but no connection of it leads over the road; add one or "
                       "remove the road",
                       road.record.junction_id));
  }
}

const LaneSection* touching_section(const RoadSource& road, bool at_end) {
  if (road.record.sections.empty()) return nullptr;
  return at_end ? &road.record.sections.back() : &road.record.sections.front();
}

void unknown_lanes(const Source& source, const validation::ValidateOptions&,
                   validation::Report& report) {
  for_each_connection(source, [&](const Connection& connection) {
    const RoadSource* via = connection.connecting;
    if (via == nullptr || connection.record.direct) return;
    const LaneSection* section = touching_section(*via, connection.at_end());
    if (section == nullptr || section->single_side) return;
    for (const auto link : connection.record.node.children("laneLink")) {
      const int to = link.attribute("to").as_int();
      if (section->find(to) != nullptr) continue;
      add(report, connection,
          fmt::format("connection {} leads to lane {} of road {}, which is not there; correct it",
                      id_of(connection), to, via->record.id));
    }
  });
}

constexpr std::array<SourceRule, 14> kJunctionRules = {{
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
      "the incoming road of a connection is a connecting road of a junction"},
     connecting_roads_that_come_in},
    {{"junction.double-connection", "asam.net:xodr:1.8.0:junctions.connection.one_link_to_incoming",
      validation::Severity::warning, "two connections lead from one road to one connecting road"},
     double_connections},
    {{"junction.outgoing-lane-link",
      "asam.net:xodr:1.8.0:junctions.connection.one_link_to_incoming",
      validation::Severity::warning,
      "a lane link of a connection leads from or to a lane that runs the other way"},
     outgoing_lane_links},
    {{"junction.priority-pair", "asam.net:xodr:1.8.0:junctions.priority.high_and_low_attr",
      validation::Severity::warning, "a priority does not name both roads"},
     incomplete_priorities},
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
