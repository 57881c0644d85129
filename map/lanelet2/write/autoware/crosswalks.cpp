#include "roadbed/map/lanelet2/write/autoware/crosswalks.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <set>
#include <utility>
#include <vector>

#include "roadbed/map/lanelet2/autoware/shapes.h"

namespace roadbed::map::lanelet2 {
namespace {

/// The direction of the road at a crosswalk: that of the lane nearest to its middle.
std::optional<Eigen::Vector2d> road_direction(const RoadMap& road_map, const MapObject& crosswalk) {
  constexpr double kRadius_m = 10.0;
  const Eigen::AlignedBox2d box = [&] {
    Eigen::AlignedBox2d around;
    for (const Eigen::Vector2d& point : crosswalk.outline_in_map) around.extend(point);
    return around;
  }();
  const auto near = road_map.locate(box.center(), kRadius_m, true);
  if (near.empty()) return {};
  const geometry::Pose2 pose =
      road_map.lane(near.front().place.lane).pose_at(near.front().place.s_m);
  return Eigen::Vector2d(std::cos(pose.heading_rad), std::sin(pose.heading_rad));
}

void add_crosswalk(const RoadMap& road_map, const MapObject& crosswalk, LaneletMap& made) {
  const auto along_road = road_direction(road_map, crosswalk);
  if (!along_road) return;
  const Eigen::Vector2d walk(-along_road->y(), along_road->x());
  Eigen::AlignedBox2d box;  // x across the road, y along it
  for (const Eigen::Vector2d& point : crosswalk.outline_in_map) {
    box.extend(Eigen::Vector2d(walk.dot(point), along_road->dot(point)));
  }
  const auto corner = [&](double across_m, double along_m) {
    const Eigen::Vector2d point = across_m * walk + along_m * *along_road;
    return made.osm.add_node({point.x(), point.y(), crosswalk.z_m});
  };
  // Who walks with the road at his right has its direction behind him: left is against it.
  const auto border = [&](double along_m) {
    const std::uint32_t from = corner(box.min().x(), along_m), to = corner(box.max().x(), along_m);
    return made.osm.add_way({from, to}, {{"type", "pedestrian_marking"}});
  };
  const std::uint32_t left = border(box.min().y()), right = border(box.max().y());
  made.osm.add_relation({{MemberKind::way, left, "left"}, {MemberKind::way, right, "right"}},
                        {{"type", "lanelet"},
                         {"subtype", "crosswalk"},
                         {"location", "urban"},
                         {"one_way", "no"},
                         {"speed_limit", "10"},
                         {"participant:pedestrian", "yes"},
                         {"name", crosswalk.source_id}},
                        made.osm.fresh());
}

bool meet(const autoware::VectorMap& map, const autoware::Surface& one,
          const autoware::Surface& other) {
  if (on_other_level(one, other)) return false;
  return touch(map, autoware::closed(one.ring), other.ring) ||
         touch(map, autoware::closed(other.ring), one.ring);
}

}  // namespace

void add_crosswalk_lanelets(const RoadMap& road_map, LaneletMap& made) {
  if (is_from_lanelet2(road_map)) return;
  for (const MapObject& object : road_map.objects()) {
    if (object.type != "crosswalk" || object.outline_in_map.size() < 3) continue;
    add_crosswalk(road_map, object, made);
  }
}

void add_crosswalk_regulations(const WrittenMap& written, LaneletMap& made) {
  const autoware::VectorMap& map = written.map();
  std::set<const autoware::Lanelet*> regulated;
  for (const Relation* regulation : map.regulations()) {
    if (regulation->subtype != "crosswalk") continue;
    for (const auto* lanelet : map.lanelets(*regulation, "refers")) regulated.insert(lanelet);
  }
  for (const autoware::Lanelet& crosswalk : map.lanelets()) {
    if (crosswalk.subtype() != "crosswalk" || regulated.contains(&crosswalk)) continue;
    const std::uint32_t element =
        made.osm.add_relation({{MemberKind::relation, written.relation(crosswalk), "refers"}},
                              {{"type", "regulatory_element"}, {"subtype", "crosswalk"}});
    if (!crosswalk.surface) continue;
    for (const autoware::Lanelet* road : map.near(crosswalk.surface->box)) {
      if (road->subtype() != "road" || !meet(map, *crosswalk.surface, *road->surface)) continue;
      made.osm.relations[written.relation(*road)].members.push_back(
          {MemberKind::relation, element, "regulatory_element"});
    }
  }
}

}  // namespace roadbed::map::lanelet2
