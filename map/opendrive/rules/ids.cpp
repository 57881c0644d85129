#include <fmt/format.h>

#include <array>
#include <set>
#include <string>
#include <unordered_map>

#include "roadbed/map/opendrive/rules/source.h"

namespace roadbed::map::opendrive::rules {
namespace {

/// One class of elements whose ids must differ.
class UniqueIds {
 public:
  UniqueIds(const Source& source, const char* kind, validation::Severity severity,
            validation::Report& report)
      : source_(source), kind_(kind), severity_(severity), report_(report) {}

  void add(pugi::xml_node node) {
    const std::string id = node.attribute("id").value();
    if (id.empty()) return;
    const long line = source_.xml.line_of(node);
    const auto [first, is_new] = first_line_.emplace(id, line);
    if (is_new) return;
    validation::Finding& finding =
        report_.add(fmt::format("{} {}", kind_, id), std::nullopt,
                    fmt::format("has the id of the {} in line {}; give one of them another id",
                                kind_, first->second));
    finding.line = line;
    finding.severity = severity_;
  }

 private:
  const Source& source_;
  const char* kind_;
  validation::Severity severity_;
  validation::Report& report_;
  std::unordered_map<std::string, long> first_line_;
};

void duplicate_ids(const Source& source, const validation::ValidateOptions&,
                   validation::Report& report) {
  UniqueIds roads(source, "road", validation::Severity::error, report);
  UniqueIds signals(source, "signal", validation::Severity::warning, report);
  UniqueIds objects(source, "object", validation::Severity::warning, report);
  for (const RoadSource& road : source.roads) {
    roads.add(road.record.node);
    for (const SignalRecord& signal : road.record.signals) signals.add(signal.node);
    for (const ObjectRecord& object : road.record.objects) objects.add(object.node);
  }
  UniqueIds junctions(source, "junction", validation::Severity::error, report);
  for (const JunctionRecord& junction : source.document.junctions) junctions.add(junction.node);
  UniqueIds controllers(source, "controller", validation::Severity::warning, report);
  for (const auto node : source.xml.root().children("controller")) controllers.add(node);
}

void duplicate_lane_ids(const Source& source, const validation::ValidateOptions&,
                        validation::Report& report) {
  for (const RoadSource& road : source.roads) {
    for (const LaneSection& section : road.record.sections) {
      std::set<int> seen;
      for (const LaneRecord& lane : section.listed()) {
        if (seen.insert(lane.id).second) continue;
        validation::Finding& finding =
            add_at(report, source, road, lane.node,
                   "its section has two lanes of this id; number them 1, 2, … "
                   "from the middle outwards");
        finding.element = lane_element(road, section, lane.id);
      }
    }
  }
}

void dangling_road_links(const Source& source, const validation::ValidateOptions&,
                         validation::Report& report) {
  for (const RoadSource& road : source.roads) {
    for (const auto* link : {&road.record.predecessor, &road.record.successor}) {
      if (!*link) continue;
      const RoadLink& to = **link;
      const bool is_there = to.to_junction ? source.junction_by_id.contains(to.element_id)
                                           : source.find_road(to.element_id) != nullptr;
      if (is_there) continue;
      add_at(report, source, road, to.node,
             fmt::format("its {} is {} {}, which is not there; remove the link or add it",
                         to.node.name(), to.to_junction ? "junction" : "road", to.element_id));
    }
  }
}

void dangling_junctions_of_roads(const Source& source, const validation::ValidateOptions&,
                                 validation::Report& report) {
  for (const RoadSource& road : source.roads) {
    if (road.record.junction_id.empty() || source.junction_by_id.contains(road.record.junction_id))
      continue;
    add_at(report, source, road, road.record.node,
           fmt::format("is in junction {}, which is not there; correct the attribute junction",
                       road.record.junction_id));
  }
}

void dangling_connections(const Source& source, const validation::ValidateOptions&,
                          validation::Report& report) {
  for (const JunctionRecord& junction : source.document.junctions) {
    for (const JunctionConnection& connection : junction.connections) {
      for (const char* role : {"incomingRoad", "connectingRoad", "linkedRoad"}) {
        const auto road = connection.node.attribute(role);
        if (!road || source.find_road(road.value()) != nullptr) continue;
        report
            .add(fmt::format("junction {}", junction.id), std::nullopt,
                 fmt::format("{}=\"{}\" of connection {} is not there; correct or remove it", role,
                             road.value(), connection.node.attribute("id").value()))
            .line = connection.line;
      }
    }
  }
}

std::set<std::string_view> signal_ids(const Source& source) {
  std::set<std::string_view> ids;
  for (const RoadSource& road : source.roads) {
    for (const SignalRecord& signal : road.record.signals) ids.insert(signal.id);
  }
  return ids;
}

void dangling_signals(const Source& source, const validation::ValidateOptions&,
                      validation::Report& report) {
  const std::set<std::string_view> known = signal_ids(source);
  for (const RoadSource& road : source.roads) {
    for (const SignalReference& reference : road.record.signal_references) {
      if (known.contains(reference.signal_id)) continue;
      validation::Finding& finding =
          add_at(report, source, road, reference.node,
                 fmt::format("refers to signal {}, which is not there; correct or remove it",
                             reference.signal_id));
      if (source.is_since(7)) {
        finding.asam_rule = "asam.net:xodr:1.7.0:road.signal.reference.used_for_signals_only";
      }
    }
  }
  for (const auto controller : source.xml.root().children("controller")) {
    for (const auto control : controller.children("control")) {
      const char* id = control.attribute("signalId").value();
      if (known.contains(id)) continue;
      report
          .add(fmt::format("controller {}", controller.attribute("id").value()), std::nullopt,
               fmt::format("controls signal {}, which is not there; correct or remove it", id))
          .line = source.xml.line_of(control);
    }
  }
}

constexpr std::string_view kDefined = "asam.net:xodr:1.4.0:ids.only_ref_defined_ids";

constexpr std::array<SourceRule, 6> kIdRules = {{
    {{"id.duplicate", "asam.net:xodr:1.4.0:ids.id_unique_in_class", validation::Severity::error,
      "two elements of one kind have the same id"},
     duplicate_ids},
    {{"id.duplicate-lane", "asam.net:xodr:1.4.0:ids.id_unique_in_lane_section",
      validation::Severity::error, "two lanes of a section have the same id"},
     duplicate_lane_ids},
    {{"id.dangling-road-link", kDefined, validation::Severity::error,
      "a road's predecessor or successor is not there"},
     dangling_road_links},
    {{"id.dangling-junction", kDefined, validation::Severity::error,
      "a road says that it is in a junction that is not there"},
     dangling_junctions_of_roads},
    {{"id.dangling-connection", kDefined, validation::Severity::error,
      "a junction connects a road that is not there"},
     dangling_connections},
    {{"id.dangling-signal", kDefined, validation::Severity::warning,
      "a controller or a reference names a signal that is not there"},
     dangling_signals},
}};

}  // namespace

std::span<const SourceRule> id_rules() { return kIdRules; }

}  // namespace roadbed::map::opendrive::rules
