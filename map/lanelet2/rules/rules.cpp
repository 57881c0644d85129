#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <map>
#include <set>
#include <unordered_set>

#include "roadbed/map/lanelet2/rules/source.h"

namespace roadbed::map::lanelet2::rules {
namespace {

void duplicate_ids(const Source& source, const validation::ValidateOptions&,
                   validation::Report& report) {
  const auto first = [&](pugi::xml_node element) {
    const std::string_view kind = element.name();
    const ById& list = kind == "node"  ? source.nodes
                       : kind == "way" ? source.ways
                                       : source.relations;
    return list.at(element.attribute("id").value());
  };
  for (const auto* list : {&source.node_list, &source.way_list, &source.relation_list}) {
    for (const auto element : *list) {
      if (first(element) == element) continue;
      add_at(report, source, element,
             fmt::format("has the id of the {} in line {}; give one of them another id",
                         element.name(), source.xml.line_of(first(element))));
    }
  }
}

const ById* list_of(const Source& source, std::string_view type) {
  if (type == "node") return &source.nodes;
  if (type == "way") return &source.ways;
  return type == "relation" ? &source.relations : nullptr;
}

/// References of one element that lead nowhere: a finding for all of them.
class Dangling {
 public:
  template <typename Describe>
  void add(const Describe& describe) {
    if (count_++ == 0) first_ = describe();
  }

  void report(const Source& source, pugi::xml_node element, validation::Report& report) const {
    if (count_ == 0) return;
    const std::string more = count_ > 1 ? fmt::format(", like {} more", count_ - 1) : std::string();
    add_at(report, source, element,
           fmt::format("its {} is not in the file{}; add or remove it", first_, more));
  }

 private:
  std::string first_;
  std::size_t count_ = 0;
};

void dangling_members(const Source& source, const validation::ValidateOptions&,
                      validation::Report& report) {
  for (const auto relation : source.relation_list) {
    Dangling dangling;
    for (const auto member : relation.children("member")) {
      const char *type = member.attribute("type").value(), *id = member.attribute("ref").value();
      const ById* list = list_of(source, type);
      if (list == nullptr || list->contains(id)) continue;
      dangling.add([&] {
        return fmt::format("member \"{}\", {} {},", member.attribute("role").value(), type, id);
      });
    }
    dangling.report(source, relation, report);
  }
  for (const auto way : source.way_list) {
    Dangling dangling;
    for (const auto node : way.children("nd")) {
      const char* id = node.attribute("ref").value();
      if (!source.nodes.contains(id)) dangling.add([&] { return fmt::format("node {}", id); });
    }
    dangling.report(source, way, report);
  }
}

void missing_borders(const Source& source, const validation::ValidateOptions&,
                     validation::Report& report) {
  for (const Lanelet& lanelet : source.lanelets) {
    for (const std::string_view role : {"left", "right"}) {
      const auto members = lanelet.node.children("member");
      if (std::any_of(members.begin(), members.end(), [&](pugi::xml_node member) {
            return role == member.attribute("role").value();
          })) {
        continue;
      }
      add_at(report, source, lanelet,
             fmt::format("has no {} border; add the way as its member", role));
    }
  }
}

void short_ways(const Source& source, const validation::ValidateOptions&,
                validation::Report& report) {
  for (const auto way : source.way_list) {
    const auto nodes = way.children("nd");
    if (std::distance(nodes.begin(), nodes.end()) >= 2) continue;
    add_at(report, source, way, "has fewer than two nodes; add them or remove the way");
  }
}

/// Autoware names the area of an intersection in a tag of the lanelets in it.
void dangling_areas(const Source& source, const validation::ValidateOptions&,
                    validation::Report& report) {
  for (const Lanelet& lanelet : source.lanelets) {
    const std::string_view area = tag(lanelet.node, "intersection_area");
    if (area.empty() || source.ways.contains(area) || source.relations.contains(area)) continue;
    add_at(report, source, lanelet,
           fmt::format("intersection_area={} is not in the file; correct the tag or add it", area));
  }
}

void missing_subtypes(const Source& source, const validation::ValidateOptions&,
                      validation::Report& report) {
  for (const Lanelet& lanelet : source.lanelets) {
    if (!tag(lanelet.node, "subtype").empty()) continue;
    add_at(report, source, lanelet,
           "has no subtype, so that nobody knows who may use it; add subtype=road or another one");
  }
}

bool is_known_subtype(std::string_view subtype) {
  static const std::set<std::string_view> kKnown = {
      "road",         "highway", "play_street",   "emergency_lane", "bus_lane",
      "bicycle_lane", "exit",    "walkway",       "shared_walkway", "crosswalk",
      "stairs",       "rail",    "road_shoulder", "pedestrian_lane"};
  return kKnown.contains(subtype);
}

bool names_participants(pugi::xml_node lanelet) {
  const auto tags = lanelet.children("tag");
  return std::any_of(tags.begin(), tags.end(), [](pugi::xml_node one) {
    return std::string_view(one.attribute("k").value()).starts_with("participant");
  });
}

void missing_participants(const Source& source, const validation::ValidateOptions&,
                          validation::Report& report) {
  for (const Lanelet& lanelet : source.lanelets) {
    const std::string_view subtype = tag(lanelet.node, "subtype");
    if (subtype.empty() || is_known_subtype(subtype) || names_participants(lanelet.node)) continue;
    add_at(report, source, lanelet,
           fmt::format("has the unknown subtype \"{}\" and no participants; add participant:… tags",
                       subtype));
  }
}

void missing_locations(const Source& source, const validation::ValidateOptions&,
                       validation::Report& report) {
  long count = 0;
  pugi::xml_node first;
  for (const Lanelet& lanelet : source.lanelets) {
    const std::string_view subtype = tag(lanelet.node, "subtype");
    if (subtype != "road" || !tag(lanelet.node, "location").empty()) continue;
    if (count++ == 0) first = lanelet.node;
  }
  if (count == 0) return;
  report
      .add("map", std::nullopt,
           fmt::format("{} lanelets of subtype road, this one first, have no location, from which "
                       "their speed limit follows; add location=urban or nonurban",
                       count))
      .line = source.xml.line_of(first);
}

/// Two border ends of a lanelet: where it begins, or where it ends.
using Edge = std::pair<std::string_view, std::string_view>;  // left, right

Edge start_of(const Lanelet& lanelet) { return {lanelet.left.front(), lanelet.right.front()}; }
Edge end_of(const Lanelet& lanelet) { return {lanelet.left.back(), lanelet.right.back()}; }
Edge crossed(const Edge& edge) { return {edge.second, edge.first}; }

void swapped_borders(const Source& source, const validation::ValidateOptions&,
                     validation::Report& report) {
  std::multiset<Edge> starts, ends;
  for (const Lanelet& lanelet : source.lanelets) {
    if (lanelet.left.empty()) continue;
    starts.insert(start_of(lanelet));
    ends.insert(end_of(lanelet));
  }
  for (const Lanelet& lanelet : source.lanelets) {
    if (lanelet.left.empty() || tag(lanelet.node, "one_way") == "no") continue;
    const bool goes_on = starts.contains(end_of(lanelet)) || ends.contains(start_of(lanelet));
    const bool collides =
        ends.contains(crossed(end_of(lanelet))) && starts.contains(crossed(start_of(lanelet)));
    if (goes_on || !collides) continue;
    add_at(report, source, lanelet,
           "runs against the lanelets before and behind it; swap its left and right border");
  }
}

/// Border ends that lie beside each other without being one node, found by a grid.
class NearEnds {
 public:
  explicit NearEnds(const Source& source) : source_(source) {}

  void add(std::string_view node) {
    const auto place = source_.place(node);
    if (place && seen_.insert(node).second) cells_[cell_of(*place)].push_back({node, *place});
  }

  /// Another node within reach.
  std::string_view other_than(std::string_view node) const {
    const auto place = source_.place(node);
    if (!place) return {};
    const auto [x, y] = cell_of(*place);
    for (long i = x - 1; i <= x + 1; ++i) {
      for (long j = y - 1; j <= y + 1; ++j) {
        const auto cell = cells_.find({i, j});
        if (cell == cells_.end()) continue;
        for (const auto& [other, at] : cell->second) {
          if (other != node && (at - *place).norm() < kReach) return other;
        }
      }
    }
    return {};
  }

 private:
  static constexpr double kReach = 0.1;  // [m]
  using Cell = std::pair<long, long>;
  static Cell cell_of(const Eigen::Vector2d& place) {
    return {std::lround(place.x() / kReach), std::lround(place.y() / kReach)};
  }

  const Source& source_;
  std::unordered_set<std::string_view> seen_;
  std::map<Cell, std::vector<std::pair<std::string_view, Eigen::Vector2d>>> cells_;
};

double elevation_m(const Source& source, std::string_view node) {
  const auto found = source.nodes.find(node);
  if (found == source.nodes.end()) return 0.0;
  const std::string_view written = tag(found->second, "ele");
  return written.empty() ? 0.0 : std::strtod(written.data(), nullptr);
}

void unshared_borders(const Source& source, const validation::ValidateOptions&,
                      validation::Report& report) {
  constexpr double kSameLevel = 1.0;  // [m]
  NearEnds ends(source);
  for (const Lanelet& lanelet : source.lanelets) {
    if (lanelet.left.empty()) continue;
    for (const auto& [left, right] : {start_of(lanelet), end_of(lanelet)}) {
      ends.add(left);
      ends.add(right);
    }
  }
  std::set<std::pair<std::string_view, std::string_view>> said;
  for (const Lanelet& lanelet : source.lanelets) {
    if (lanelet.left.empty()) continue;
    for (const std::string_view node :
         {lanelet.left.front(), lanelet.left.back(), lanelet.right.front(), lanelet.right.back()}) {
      const std::string_view other = ends.other_than(node);
      if (other.empty() || !said.insert(std::minmax(node, other)).second) continue;
      if (std::abs(elevation_m(source, node) - elevation_m(source, other)) > kSameLevel) continue;
      validation::Finding& finding =
          add_at(report, source, lanelet,
                 fmt::format("its border ends in node {}, less than 0.1 m from node {} of another "
                             "lanelet, so that the two are not linked; merge the nodes",
                             node, other));
      finding.in_map = source.local_place(node);
    }
  }
}

void zero_coordinates(const Source& source, const validation::ValidateOptions&,
                      validation::Report& report) {
  long count = 0;
  pugi::xml_node first;
  for (const auto node : source.node_list) {
    if (source.xml.optional_number(node, "lat").value_or(1.0) != 0.0 ||
        source.xml.optional_number(node, "lon").value_or(1.0) != 0.0 ||
        !tag(node, "local_x").empty()) {
      continue;
    }
    if (count++ == 0) first = node;
  }
  if (count == 0) return;
  add_at(report, source, first,
         fmt::format("and {} more have latitude and longitude 0 and no local_x, local_y; give them "
                     "their place",
                     count - 1));
}

void broken_coordinates(const Source& source, const validation::ValidateOptions&,
                        validation::Report& report) {
  for (const auto node : source.node_list) {
    if (!tag(node, "local_x").empty()) continue;
    const auto latitude = source.xml.optional_number(node, "lat");
    const auto longitude = source.xml.optional_number(node, "lon");
    if (latitude && longitude && std::abs(*latitude) <= 90.0 && std::abs(*longitude) <= 180.0) {
      continue;
    }
    add_at(report, source, node,
           fmt::format("lat=\"{}\" lon=\"{}\" is no place on earth; correct it",
                       node.attribute("lat").value(), node.attribute("lon").value()));
  }
}

void borders_without_type(const Source& source, const validation::ValidateOptions&,
                          validation::Report& report) {
  std::set<std::string_view> seen;
  for (const Lanelet& lanelet : source.lanelets) {
    for (const auto member : lanelet.node.children("member")) {
      const std::string_view role = member.attribute("role").value();
      const auto way = source.ways.find(member.attribute("ref").value());
      if ((role != "left" && role != "right") || way == source.ways.end()) continue;
      if (!seen.insert(way->first).second || !tag(way->second, "type").empty()) continue;
      add_at(report, source, way->second,
             "is a border without a type, so that nobody knows whether it may be crossed; add "
             "type=line_thin, curbstone, virtual or another one");
    }
  }
}

bool is_speed(std::string_view text) {
  double value = 0.0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || !(value > 0.0)) return false;
  std::string_view unit(end, static_cast<std::size_t>(text.data() + text.size() - end));
  while (unit.starts_with(' ')) unit.remove_prefix(1);
  static const std::set<std::string_view> kUnits = {"", "km/h", "kmh", "kph", "mph", "m/s", "mps"};
  return kUnits.contains(unit);
}

void broken_speeds(const Source& source, const validation::ValidateOptions&,
                   validation::Report& report) {
  for (const Lanelet& lanelet : source.lanelets) {
    const std::string_view speed = tag(lanelet.node, "speed_limit");
    if (speed.empty() || is_speed(speed)) continue;
    add_at(report, source, lanelet,
           fmt::format("speed_limit=\"{}\" is no positive number with a unit (km/h, mph, m/s); "
                       "correct it",
                       speed));
  }
}

constexpr std::array<SourceRule, 14> kLaneletRules = {{
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
    {{"lanelet2.dangling-area",
      {},
      validation::Severity::warning,
      "a lanelet's intersection_area is not in the file"},
     dangling_areas},
    {{"lanelet2.missing-border",
      {},
      validation::Severity::error,
      "a lanelet has no left or right border"},
     missing_borders},
    {{"lanelet2.short-way", {}, validation::Severity::warning, "a way has fewer than two nodes"},
     short_ways},
    {{"lanelet2.no-subtype", {}, validation::Severity::warning, "a lanelet has no subtype"},
     missing_subtypes},
    {{"lanelet2.no-participant",
      {},
      validation::Severity::warning,
      "a lanelet of unknown subtype does not say who may use it"},
     missing_participants},
    {{"lanelet2.no-location",
      {},
      validation::Severity::info,
      "lanelets of subtype road have no location; once per map"},
     missing_locations},
    {{"lanelet2.swapped-borders",
      {},
      validation::Severity::error,
      "a one-way lanelet runs against those before and behind it"},
     swapped_borders},
    {{"lanelet2.unshared-border",
      {},
      validation::Severity::warning,
      "borders of two lanelets end within 0.1 m of each other in different nodes"},
     unshared_borders},
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
    {{"lanelet2.border-without-type", {}, validation::Severity::info, "a border has no type"},
     borders_without_type},
    {{"lanelet2.broken-speed",
      {},
      validation::Severity::warning,
      "a lanelet's speed_limit is no positive number with a unit"},
     broken_speeds},
}};

}  // namespace

std::span<const SourceRule> lanelet_rules() { return kLaneletRules; }

}  // namespace roadbed::map::lanelet2::rules
