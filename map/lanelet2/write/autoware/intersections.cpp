#include "roadbed/map/lanelet2/write/autoware/intersections.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "roadbed/geometry/polygons/convex_hull.h"
#include "roadbed/geometry/primitives/disjoint_sets.h"
#include "roadbed/map/derived/conflicts.h"
#include "roadbed/map/derived/crossings.h"
#include "roadbed/map/elements/lane_bend.h"
#include "roadbed/map/lanelet2/autoware/shapes.h"
#include "roadbed/map/lanelet2/traffic_rules.h"

namespace roadbed::map::lanelet2 {
namespace {

constexpr double kCovered = 0.99;  // share of a lanelet from which on it lies in an area

using Group = std::vector<LaneId>;

class IntersectionMaker {
 public:
  IntersectionMaker(const RoadMap& road_map, const WrittenMap& written, LaneletMap& made)
      : road_map_(road_map), written_(written), made_(made), lanes_(made.lanes_by_relation()) {}

  void make() {
    bool has_areas = false;
    for (const Way& way : written_.map().document().ways) {
      if (way.type != "intersection_area" || !autoware::is_area(way)) continue;
      has_areas = true;
      tag_those_in(way);
    }
    if (has_areas) return;
    const std::vector<Group> named = by_crossings();
    for (const Group& group : named.empty() ? by_conflicts() : named) add_area(group);
  }

 private:
  /// Roads that have a place.
  bool is_wanted(LaneId lane) const {
    if (!made_.lanelets[lane.index]) return false;
    const Attributes& tags = made_.tags_of(lane);
    return tag_of(tags, "subtype") == "road" && surface_of(lane) != nullptr;
  }

  const autoware::Surface* surface_of(LaneId lane) const {
    const autoware::Lanelet* lanelet = written_.lanelet(*made_.lanelets[lane.index]);
    return lanelet != nullptr && lanelet->surface ? &*lanelet->surface : nullptr;
  }

  /// Roads that lie in an area of the source and do not say so.
  void tag_those_in(const Way& area) {
    const autoware::Line2 ring = plan_of(written_.map(), area);
    for (const autoware::Lanelet* lanelet : written_.map().near(geometry::box_around(ring))) {
      const auto found = lanes_.find(written_.relation(*lanelet));
      if (found == lanes_.end() || !is_wanted(found->second)) continue;
      if (!lanelet->tag("intersection_area").empty()) continue;
      if (covered_share(written_.map(), *lanelet->surface, ring) < kCovered) continue;
      tag(found->second, std::to_string(area.id));
    }
  }

  /// Roads inside each crossing that the map names.
  std::vector<Group> by_crossings() const {
    std::vector<bool> wanted;
    for (const Lane& lane : road_map_.lanes()) wanted.push_back(is_wanted(lane.id));
    const auto crossings = crossings_of_lanes(road_map_, wanted);
    std::map<std::uint32_t, Group> groups;
    for (std::uint32_t lane = 0; lane < wanted.size(); ++lane) {
      if (crossings[lane] && wanted[lane]) groups[*crossings[lane]].push_back(LaneId{lane});
    }
    std::vector<Group> found;
    for (auto& [number, group] : groups) found.push_back(std::move(group));
    return found;
  }

  std::vector<Group> by_conflicts() const {
    geometry::DisjointSets joined(road_map_.lanes().size());
    std::vector<bool> crosses(road_map_.lanes().size()), meets(road_map_.lanes().size());
    for (const Conflict& conflict : find_conflicts(road_map_)) {
      if (!is_wanted(conflict.one) || !is_wanted(conflict.other)) continue;
      joined.join(conflict.one.index, conflict.other.index);
      meets[conflict.one.index] = meets[conflict.other.index] = true;
      if (conflict.kind == ConflictKind::crossing) crosses[conflict.one.index] = true;
    }
    std::map<std::size_t, Group> groups;
    std::map<std::size_t, bool> has_crossing;
    for (std::uint32_t lane = 0; lane < meets.size(); ++lane) {
      if (!meets[lane]) continue;
      groups[joined.of(lane)].push_back(LaneId{lane});
      if (crosses[lane]) has_crossing[joined.of(lane)] = true;
    }
    std::vector<Group> found;
    for (auto& [root, group] : groups) {
      if (has_crossing.contains(root)) found.push_back(std::move(group));
    }
    return found;
  }

  /// The hull of the corners of some lanelets, as places of nodes.
  std::vector<std::uint32_t> hull(const Group& group) const {
    std::map<std::pair<double, double>, std::uint32_t> node_at;
    std::vector<Eigen::Vector2d> corners;
    const Document& document = written_.map().document();
    for (const LaneId lane : group) {
      for (const Border& border : made_.borders[lane.index]) {
        const std::vector<std::uint32_t>& nodes = made_.osm.ways[border.way].nodes;
        for (const std::uint32_t node : {nodes.front(), nodes.back()}) {
          corners.emplace_back(document.nodes[node].in_map.head<2>());
          node_at.emplace(std::pair(corners.back().x(), corners.back().y()), node);
        }
      }
    }
    std::vector<std::uint32_t> nodes;
    for (const Eigen::Vector2d& corner : geometry::convex_hull(corners)) {
      nodes.push_back(node_at.at({corner.x(), corner.y()}));
    }
    return nodes;
  }

  autoware::Line2 ring_of(const std::vector<std::uint32_t>& nodes) const {
    autoware::Line2 ring;
    for (const std::uint32_t node : nodes) {
      ring.emplace_back(written_.map().document().nodes[node].in_map.head<2>());
    }
    return ring;
  }

  Group lying_in(const autoware::Line2& ring, const Group& group) const {
    Group inside;
    std::ranges::copy_if(group, std::back_inserter(inside), [&](LaneId lane) {
      return covered_share(written_.map(), *surface_of(lane), ring) >= kCovered;
    });
    return inside;
  }

  void add_area(const Group& group) {
    if (group.empty()) return;
    std::vector<std::uint32_t> nodes = hull(group);
    if (nodes.size() < 3) return;
    const Group inside = lying_in(ring_of(nodes), group);
    if (inside.empty()) return;
    nodes.push_back(nodes.front());
    const std::uint32_t way = made_.osm.add_way(
        std::move(nodes),
        {{"type", "intersection_area"}, {"subtype", "intersection_area"}, {"area", "yes"}});
    for (const LaneId lane : inside) tag(lane, std::to_string(made_.osm.ways[way].id));
  }

  void tag(LaneId lane, const std::string& area) {
    Attributes& tags = made_.tags_of(lane);
    set_tag(tags, "intersection_area", area);
    if (tag_of(tags, "turn_direction").empty()) {
      set_tag(tags, "turn_direction", direction(road_map_.lane(lane)));
    }
    for (const Border& border : made_.borders[lane.index]) {
      make_virtual(made_.osm.ways[border.way].tags);
    }
  }

  static std::string_view direction(const Lane& lane) {
    const double bend = bend_rad(lane);
    if (std::abs(bend) < kTurnsOff_rad) return "straight";
    return bend > 0.0 ? "left" : "right";
  }

  /// What is painted on an intersection leads nobody; its edges, and who may cross a line, stay.
  static void make_virtual(Attributes& line) {
    if (tag_of(line, "type") == "road_border") return;
    const CrossingRule before = rule_of(line);
    const bool is_edge = tag_of(line, "type") == "curbstone";
    set_tag(line, "type", is_edge ? "road_border" : "virtual");
    for (const char* key : {"subtype", "color", "width"}) remove_tag(line, key);
    const CrossingRule after = rule_of(line);
    if (after.to_left == before.to_left && after.to_right == before.to_right) return;
    set_tag(line, "lane_change:left", before.to_left ? "yes" : "no");
    set_tag(line, "lane_change:right", before.to_right ? "yes" : "no");
  }

  static CrossingRule rule_of(const Attributes& line) {
    return crossing_rule(views_of(line), Participants::vehicles());
  }

  const RoadMap& road_map_;
  const WrittenMap& written_;
  LaneletMap& made_;
  const std::map<std::uint32_t, LaneId> lanes_;
};

}  // namespace

void add_intersections(const RoadMap& road_map, const WrittenMap& written, LaneletMap& made) {
  IntersectionMaker(road_map, written, made).make();
}

}  // namespace roadbed::map::lanelet2
