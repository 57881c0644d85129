#include "roadbed/map/lanelet2/write/autoware/traffic_lights.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "roadbed/map/lanelet2/write/autoware/regulation_users.h"

namespace roadbed::map::lanelet2 {
namespace {

constexpr double kSameEdge_m = 1.0;     // along a lanelet
constexpr double kUsualHeight_m = 1.0;  // of three bulbs of 20 to 30 cm in their body

Eigen::Vector3d point_at(const LaneLine& line, double station_m) {
  const Eigen::Vector2d at = Lane::point_at(line, station_m);
  return {at.x(), at.y(), Lane::height_at(line, station_m)};
}

class LightCompleter {
 public:
  LightCompleter(const RoadMap& road_map, const WrittenMap& written, LaneletMap& made)
      : road_map_(road_map),
        keeps_users_(is_from_lanelet2(road_map)),
        written_(written),
        made_(made),
        osm_(made.osm),
        lanes_(made.lanes_by_relation()) {}

  AssumedOfLights complete() {
    std::map<std::uint32_t, std::vector<LaneId>> users = users_of_regulations(made_);
    for (std::uint32_t i = 0; i < osm_.relations.size(); ++i) {
      if (!is_light_element(osm_.relations[i])) continue;
      std::vector<LaneId>& lanes = users[i];
      if (!keeps_users_) lanes = moved_into_intersection(i, std::move(lanes));
      face_drivers(i, lanes);
      if (ways(i, "light_bulbs").empty()) add_bulbs(i);
      if (!lanes.empty() && is_for_vehicles(i, lanes)) add_line(i, lanes);
    }
    for (OsmWay& way : osm_.ways) {
      if (tag_of(way.tags, "type") == "traffic_light") height_m(way);
    }
    return assumed_;
  }

 private:
  static bool is_light_element(const OsmRelation& relation) {
    return tag_of(relation.tags, "type") == "regulatory_element" &&
           tag_of(relation.tags, "subtype") == "traffic_light";
  }

  bool is_in_intersection(LaneId lane) const {
    return !tag_of(made_.tags_of(lane), "turn_direction").empty();
  }

  /// Instead of the roads before the stop line, those behind it.
  std::vector<LaneId> moved_into_intersection(std::uint32_t element, std::vector<LaneId> users) {
    std::vector<LaneId> inside;
    for (const LaneId user : users) {
      if (is_in_intersection(user)) {
        inside.push_back(user);
        continue;
      }
      for (const LaneId next : following(user)) {
        if (is_in_intersection(next)) inside.push_back(next);
      }
    }
    if (inside.empty()) return users;
    std::ranges::sort(inside);
    inside.erase(std::unique(inside.begin(), inside.end()), inside.end());
    for (const LaneId user : users) forget_regulation(made_, user, element);
    for (const LaneId lane : inside) name_regulation(made_, lane, element);
    return inside;
  }

  std::vector<LaneId> following(LaneId lane) const {
    std::vector<LaneId> next;
    const autoware::Lanelet* lanelet = written_.lanelet(*made_.lanelets[lane.index]);
    if (lanelet == nullptr) return next;
    for (const autoware::Lanelet* behind : written_.map().following(*lanelet)) {
      const auto found = lanes_.find(written_.relation(*behind));
      if (found != lanes_.end()) next.push_back(found->second);
    }
    return next;
  }

  std::vector<std::uint32_t> ways(std::uint32_t element, std::string_view role) const {
    std::vector<std::uint32_t> found;
    for (const OsmMember& member : osm_.relations[element].members) {
      if (member.kind == MemberKind::way && member.role == role) found.push_back(member.index);
    }
    return found;
  }

  double height_m(OsmWay& light) {
    const double given_m = number_in(tag_of(light.tags, "height"));
    if (given_m > 0.0) return given_m;
    set_tag(light.tags, "height", fmt::format("{}", kUsualHeight_m));
    ++assumed_.heights;
    return kUsualHeight_m;
  }

  /// Lets the line of each light run from left to right as those see it who drive towards it.
  void face_drivers(std::uint32_t element, const std::vector<LaneId>& users) {
    for (const std::uint32_t light : ways(element, "refers")) {
      std::vector<std::uint32_t>& nodes = osm_.ways[light].nodes;
      const bool has_line = nodes.size() >= 2 && !users.empty();
      const bool turned_away =
          has_line && std::ranges::all_of(users, [&](LaneId user) {
            const LaneletEdge edge = edge_at_line(user, light);
            const Eigen::Vector3d along =
                osm_.nodes[nodes.back()].in_map - osm_.nodes[nodes.front()].in_map;
            return along.head<2>().dot((edge.right - edge.left).head<2>()) < 0.0;
          });
      if (!turned_away) continue;
      std::ranges::reverse(nodes);
      ++assumed_.facings;
    }
  }

  /// Where vehicles stop for a light that a lanelet names: before an intersection, else beside the
  /// light, at the lanelet's end where it stands beyond that.
  LaneletEdge edge_at_line(LaneId user, std::uint32_t light) const {
    if (is_in_intersection(user)) return start_edge(made_, user);
    const LaneletEdge end = end_edge(made_, user);
    const std::vector<Eigen::Vector3d> line = osm_.points(light);
    const auto is_inside = [&](LaneId next) { return is_in_intersection(next); };
    if (line.empty() || std::ranges::any_of(following(user), is_inside)) return end;
    const Lane& lane = road_map_.lane(user);
    const double s_m = lane.centre.in_map.project(line.front().head<2>()).s_m;
    if (s_m > lane.length_m() - kSameEdge_m) return end;
    return {point_at(lane.left, s_m), point_at(lane.right, s_m)};
  }

  /// Red, yellow and green from top to bottom, in the middle of the light's line.
  void add_bulbs(std::uint32_t element) {
    for (const std::uint32_t light : ways(element, "refers")) {
      if (osm_.ways[light].nodes.size() < 2) continue;
      const auto [known, is_new] = bulbs_.try_emplace(light);
      if (is_new) known->second = made_bulbs(light, std::to_string(osm_.ways[light].id));
      osm_.relations[element].members.push_back({MemberKind::way, known->second, "light_bulbs"});
    }
  }

  std::uint32_t made_bulbs(std::uint32_t light, const std::string& id) {
    const double body_m = height_m(osm_.ways[light]);
    const std::vector<Eigen::Vector3d> line = osm_.points(light);
    const Eigen::Vector3d foot = 0.5 * (line.front() + line.back());
    const bool two = tag_of(osm_.ways[light].tags, "subtype") == "red_green";
    const std::vector<const char*> colours =
        two ? std::vector{"red", "green"} : std::vector{"red", "yellow", "green"};
    std::vector<std::uint32_t> nodes;
    for (std::size_t i = 0; i < colours.size(); ++i) {
      const double share =
          1.0 - (static_cast<double>(i) + 0.5) / static_cast<double>(colours.size());
      nodes.push_back(
          osm_.add_node(foot + Eigen::Vector3d(0.0, 0.0, share * body_m), {{"color", colours[i]}}));
    }
    return osm_.add_way(std::move(nodes), {{"type", "light_bulbs"}, {"traffic_light_id", id}});
  }

  bool is_for_vehicles(std::uint32_t element, const std::vector<LaneId>& users) const {
    const bool any_vehicle = std::ranges::any_of(
        users, [&](LaneId user) { return tag_of(made_.tags_of(user), "subtype") == "road"; });
    const auto lights = ways(element, "refers");
    return any_vehicle && !std::ranges::all_of(lights, [&](std::uint32_t light) {
             return tag_of(osm_.ways[light].tags, "subtype") == "red_green";
           });
  }

  /// Lights of the same lanelets have one line, if it is at the same place.
  void add_line(std::uint32_t element, const std::vector<LaneId>& users) {
    const auto lights = ways(element, "refers");
    if (!ways(element, "ref_line").empty() || lights.empty()) return;
    std::vector<LaneletEdge> edges;
    for (const LaneId user : users) edges.push_back(edge_at_line(user, lights.front()));
    auto& lines = lines_[users];
    const auto is_here = [&](const auto& line) {
      return (line.first - edges.front().left).norm() < kSameEdge_m;
    };
    auto known = std::ranges::find_if(lines, is_here);
    if (known == lines.end()) {
      known = lines.insert(known, {edges.front().left, add_stop_line(made_, edges)});
      ++assumed_.stop_lines;
    }
    osm_.relations[element].members.push_back({MemberKind::way, known->second, "ref_line"});
  }

  const RoadMap& road_map_;
  const bool keeps_users_;
  const WrittenMap& written_;
  LaneletMap& made_;
  OsmMap& osm_;
  const std::map<std::uint32_t, LaneId> lanes_;
  AssumedOfLights assumed_;
  std::map<std::uint32_t, std::uint32_t> bulbs_;  // of a light's way
  /// Before those lanelets, by a corner.
  std::map<std::vector<LaneId>, std::vector<std::pair<Eigen::Vector3d, std::uint32_t>>> lines_;
};

}  // namespace

AssumedOfLights complete_traffic_lights(const RoadMap& road_map, const WrittenMap& written,
                                        LaneletMap& made) {
  return LightCompleter(road_map, written, made).complete();
}

}  // namespace roadbed::map::lanelet2
