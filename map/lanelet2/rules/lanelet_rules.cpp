#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <set>
#include <unordered_set>

#include "roadbed/map/lanelet2/rules/source.h"
#include "roadbed/map/lanelet2/traffic_rules.h"

namespace roadbed::map::lanelet2::rules {
namespace {

void missing_borders(const Source& source, const validation::ValidateOptions&,
                     validation::Report& report) {
  for (const Lanelet& lanelet : source.lanelets) {
    for (const char* role : {"left", "right"}) {
      const auto has_role = [&](const Member& member) { return member.role == role; };
      if (std::ranges::any_of(lanelet.relation.members, has_role)) continue;
      add_at(report, source, lanelet,
             fmt::format("has no {} border; add the way as its member", role));
    }
  }
}

/// Autoware names the area of an intersection in a tag of the lanelets in it.
void dangling_areas(const Source& source, const validation::ValidateOptions&,
                    validation::Report& report) {
  for (const Lanelet& lanelet : source.lanelets) {
    const std::string_view area = lanelet.tag("intersection_area");
    const std::optional<std::int64_t> id = id_in(area);
    if (area.empty() ||
        (id && (source.document.way_index.find(*id) || source.document.relation_index.find(*id)))) {
      continue;
    }
    add_at(report, source, lanelet,
           fmt::format("intersection_area={} is not in the file; correct the tag or add it", area));
  }
}

void missing_subtypes(const Source& source, const validation::ValidateOptions&,
                      validation::Report& report) {
  for (const Lanelet& lanelet : source.lanelets) {
    if (!lanelet.relation.subtype.empty()) continue;
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

bool names_participants(const Relation& lanelet) {
  return std::ranges::any_of(lanelet.tags,
                             [](const Tag& tag) { return tag.first.starts_with("participant"); });
}

void missing_participants(const Source& source, const validation::ValidateOptions&,
                          validation::Report& report) {
  for (const Lanelet& lanelet : source.lanelets) {
    const std::string_view subtype = lanelet.relation.subtype;
    if (subtype.empty() || is_known_subtype(subtype) || names_participants(lanelet.relation)) {
      continue;
    }
    add_at(report, source, lanelet,
           fmt::format("has the unknown subtype \"{}\" and no participants; add participant:… tags",
                       subtype));
  }
}

void missing_locations(const Source& source, const validation::ValidateOptions&,
                       validation::Report& report) {
  long count = 0;
  const Relation* first = nullptr;
  for (const Lanelet& lanelet : source.lanelets) {
    if (lanelet.relation.subtype != "road" || !lanelet.tag("location").empty()) continue;
    if (count++ == 0) first = &lanelet.relation;
  }
  if (count == 0) return;
  report
      .add("map", std::nullopt,
           fmt::format("{} lanelets of subtype road, this one first, have no location, from which "
                       "their speed limit follows; add location=urban or nonurban",
                       count))
      .line = source.document.line_of(first->at);
}

void swapped_borders(const Source& source, const validation::ValidateOptions&,
                     validation::Report& report) {
  for (const Lanelet* lanelet : lanelets_with_swapped_borders(source)) {
    add_at(report, source, *lanelet,
           "runs against the lanelets before and behind it; swap its left and right border");
  }
}

/// Border ends that lie beside each other without being one node, found by a grid.
class NearEnds {
 public:
  explicit NearEnds(const std::vector<Node>& nodes) : nodes_(nodes) {}

  void add(std::uint32_t node) {
    if (seen_.insert(node).second) cells_[cell_of(node)].push_back(node);
  }

  /// Another node within reach.
  const Node* other_than(std::uint32_t node) const {
    const auto [x, y] = cell_of(node);
    for (long i = x - 1; i <= x + 1; ++i) {
      for (long j = y - 1; j <= y + 1; ++j) {
        const auto cell = cells_.find({i, j});
        if (cell == cells_.end()) continue;
        for (const std::uint32_t other : cell->second) {
          const Eigen::Vector3d apart = nodes_[other].in_map - nodes_[node].in_map;
          if (other != node && apart.head<2>().norm() < kReach) return &nodes_[other];
        }
      }
    }
    return nullptr;
  }

 private:
  static constexpr double kReach = 0.1;  // [m]
  using Cell = std::pair<long, long>;
  Cell cell_of(std::uint32_t node) const {
    const Eigen::Vector3d& at = nodes_[node].in_map;
    return {std::lround(at.x() / kReach), std::lround(at.y() / kReach)};
  }

  const std::vector<Node>& nodes_;
  std::unordered_set<std::uint32_t> seen_;
  std::map<Cell, std::vector<std::uint32_t>> cells_;
};

void unshared_borders(const Source& source, const validation::ValidateOptions&,
                      validation::Report& report) {
  constexpr double kSameLevel = 1.0;  // [m]
  const std::vector<Node>& nodes = source.document.nodes;
  NearEnds ends(nodes);
  std::set<std::pair<const Node*, const Node*>> said;  // from the first on: a lanelet's own corners
  for (const Lanelet& lanelet : source.lanelets) {
    if (!lanelet.start) continue;
    for (const auto& [left, right] : {*lanelet.start, *lanelet.end}) {
      ends.add(left);
      ends.add(right);
      said.insert(std::minmax(&nodes[left], &nodes[right]));
    }
  }
  for (const Lanelet& lanelet : source.lanelets) {
    if (!lanelet.start) continue;
    for (const std::uint32_t place :
         {lanelet.start->left, lanelet.end->left, lanelet.start->right, lanelet.end->right}) {
      const Node *node = &nodes[place], *other = ends.other_than(place);
      if (other == nullptr || !said.insert(std::minmax(node, other)).second) continue;
      if (std::abs(node->in_map.z() - other->in_map.z()) > kSameLevel) continue;
      add_at(report, source, lanelet,
             fmt::format("its border ends in node {}, less than 0.1 m from node {} of another "
                         "lanelet, so that the two are not linked; merge the nodes",
                         node->id, other->id))
          .in_map = source.local_place(place);
    }
  }
}

void borders_without_type(const Source& source, const validation::ValidateOptions&,
                          validation::Report& report) {
  std::set<std::uint32_t> seen;
  for (const Lanelet& lanelet : source.lanelets) {
    for (const Member& member : lanelet.relation.members) {
      if (member.kind != MemberKind::way) continue;
      if (member.role != "left" && member.role != "right") continue;
      const auto way = source.document.way_index.find(member.id);
      if (!way || !seen.insert(*way).second || !source.document.ways[*way].type.empty()) continue;
      add_at(report, source, source.document.ways[*way],
             "is a border without a type, so that nobody knows whether it may be crossed; add "
             "type=line_thin, curbstone, virtual or another one");
    }
  }
}

void broken_speeds(const Source& source, const validation::ValidateOptions&,
                   validation::Report& report) {
  for (const Lanelet& lanelet : source.lanelets) {
    const std::string_view speed = lanelet.tag("speed_limit");
    if (speed.empty() || speed_mps(speed).value_or(0.0) > 0.0) continue;
    add_at(report, source, lanelet,
           fmt::format("speed_limit=\"{}\" is no positive number with a unit (km/h, mph, m/s); "
                       "correct it",
                       speed));
  }
}

constexpr std::array<SourceRule, 9> kLaneletRules = {{
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
