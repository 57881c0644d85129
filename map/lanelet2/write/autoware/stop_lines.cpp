#include "roadbed/map/lanelet2/write/autoware/stop_lines.h"

#include <algorithm>
#include <set>
#include <vector>

#include "roadbed/map/lanelet2/autoware/shapes.h"

namespace roadbed::map::lanelet2 {
namespace {

constexpr double kOnRoad = 0.2;   // share of a stop line that lies on a road it holds for
constexpr double kAtEnd_m = 1.5;  // from the middle of a road's end

std::set<std::uint32_t> named_ways(const OsmMap& osm) {
  std::set<std::uint32_t> named;
  for (const OsmRelation& relation : osm.relations) {
    if (tag_of(relation.tags, "type") != "regulatory_element") continue;
    for (const OsmMember& member : relation.members) {
      if (member.kind == MemberKind::way) named.insert(member.index);
    }
  }
  return named;
}

/// Whether a stop line lies on a road, or at its end.
bool holds_on(const autoware::VectorMap& map, const autoware::Line2& line,
              const autoware::Surface& road) {
  if (share_inside(map, line, road.ring) >= kOnRoad) return true;
  const Eigen::Vector2d end = 0.5 * (road.left.back() + road.right.back()).head<2>();
  return autoware::distance_m(end, line) <= kAtEnd_m;
}

std::vector<std::uint32_t> roads_of(const WrittenMap& written, const Way& way) {
  const autoware::VectorMap& map = written.map();
  const autoware::Line2 line = plan_of(map, way);
  std::vector<std::uint32_t> roads;
  for (const autoware::Lanelet* road : map.near(geometry::box_around(line))) {
    if (road->subtype() != "road" || !holds_on(map, line, *road->surface)) continue;
    roads.push_back(written.relation(*road));
  }
  return roads;
}

}  // namespace

void add_road_markings(const WrittenMap& written, LaneletMap& made) {
  const std::set<std::uint32_t> named = named_ways(made.osm);
  const std::vector<Way>& ways = written.map().document().ways;
  for (std::uint32_t i = 0; i < ways.size(); ++i) {
    if (ways[i].type != "stop_line" || ways[i].nodes.size() < 2 || named.contains(i)) continue;
    const std::vector<std::uint32_t> roads = roads_of(written, ways[i]);
    if (roads.empty()) continue;
    const std::uint32_t element =
        made.osm.add_relation({{MemberKind::way, i, "refers"}},
                              {{"type", "regulatory_element"}, {"subtype", "road_marking"}});
    for (const std::uint32_t road : roads) {
      made.osm.relations[road].members.push_back(
          {MemberKind::relation, element, "regulatory_element"});
    }
  }
}

}  // namespace roadbed::map::lanelet2
