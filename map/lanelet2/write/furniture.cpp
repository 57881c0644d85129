#include <algorithm>
#include <cctype>
#include <cmath>
#include <map>
#include <string>
#include <utility>

#include "roadbed/map/lanelet2/write/lanelet_map.h"

namespace roadbed::map::lanelet2 {
namespace {

using Line3 = std::vector<Eigen::Vector3d>;

// A light's face as a line across the direction in which it looks.
Line3 face(const Signal& signal) {
  constexpr double half_width_m = 0.15;
  const double heading_rad = signal.heading_rad.value_or(0.0);
  const Eigen::Vector2d across(-std::sin(heading_rad), std::cos(heading_rad));
  const Eigen::Vector2d a = signal.in_map + half_width_m * across;
  const Eigen::Vector2d b = signal.in_map - half_width_m * across;
  // Whoever looks at the face has `a` at the right: the line runs from left to right for him.
  return {{b.x(), b.y(), signal.z_m}, {a.x(), a.y(), signal.z_m}};
}

std::string sign_code(const Signal& signal) {
  std::string code;
  for (const char c : signal.country) {
    code += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  }
  code += signal.type;
  if (!signal.subtype.empty() && signal.subtype != "-1") code += "-" + signal.subtype;
  return code;
}

class FurnitureMaker {
 public:
  FurnitureMaker(const RoadMap& road_map, LaneletMap& made)
      : road_map_(road_map),
        from_lanelet2_(is_from_lanelet2(road_map)),
        made_(made),
        osm_(made.osm),
        stop_lines_(road_map.stop_lines().size()) {
    for (std::size_t i = 0; i < stop_lines_.size(); ++i) {
      for (const std::string& signal : road_map.stop_lines()[i].signals) {
        first_line_of_.emplace(signal, i);
      }
    }
  }

  void make(const LaneletChoices& choices) {
    if (from_lanelet2_) {
      for (const Regulation& regulation : road_map_.regulations()) add_kept(regulation);
    } else {
      for (const Signal& signal : road_map_.signals()) {
        if (signal.dynamic) add_light(signal);
      }
    }
    add_loose();
    if (choices.areas || from_lanelet2_) add_areas();
    add_objects();
    for (const auto& line : stop_lines_) made_.stop_lines.push_back(line.value_or(0));
  }

 private:
  std::uint32_t add_line(const Line3& line, Attributes tags, const std::string& source_id) {
    const std::int64_t id = from_lanelet2_ ? osm_.keep(source_id) : osm_.fresh();
    std::vector<std::uint32_t> nodes;
    for (const Eigen::Vector3d& point : line) nodes.push_back(osm_.add_node(point));
    return osm_.add_way(std::move(nodes), std::move(tags), id);
  }

  // Lines and points that regulations name are written once, whoever names them.
  std::optional<OsmMember> member_of(const RegulationMember& member) {
    if (member.lane) {
      const auto lanelet = made_.lanelets[member.lane->index];
      if (!lanelet) return {};
      return OsmMember{MemberKind::relation, *lanelet, member.role};
    }
    if (member.in_map.empty()) return {};
    const bool is_node = member.in_map.size() == 1;
    auto& written = is_node ? made_.points : made_.lines;
    const auto known = written.find(member.source_id);
    const std::uint32_t index = known != written.end() ? known->second
                                : is_node
                                    ? osm_.add_node(member.in_map.front())
                                    : add_line(member.in_map, member.attributes, member.source_id);
    written.emplace(member.source_id, index);
    return OsmMember{is_node ? MemberKind::node : MemberKind::way, index, member.role};
  }

  // A regulatory element as it was read.
  void add_kept(const Regulation& regulation) {
    const std::int64_t id = osm_.keep(regulation.source_id);
    std::vector<OsmMember> members;
    for (const RegulationMember& member : regulation.members) {
      if (auto one = member_of(member)) members.push_back(std::move(*one));
    }
    give(osm_.add_relation(std::move(members), regulation.attributes, id), regulation.lanes);
  }

  // Lanelets name the elements that hold on them.
  void give(std::uint32_t regulation, const std::vector<LaneId>& lanes) {
    for (const LaneId lane : lanes) {
      if (!made_.lanelets[lane.index]) continue;
      osm_.relations[*made_.lanelets[lane.index]].members.push_back(
          {MemberKind::relation, regulation, "regulatory_element"});
    }
  }

  void add_light(const Signal& signal) {
    const bool speaks = std::any_of(signal.lanes.begin(), signal.lanes.end(), [&](LaneId lane) {
      return made_.lanelets[lane.index].has_value();
    });
    if (!speaks || made_.lines.contains(signal.source_id)) return;
    Attributes tags{{"type", "traffic_light"}, {"subtype", "red_yellow_green"}};
    for (const auto& [key, value] : signal.attributes) {
      if (key == "height") tags.emplace_back(key, value);
    }
    const std::uint32_t light = add_line(face(signal), std::move(tags), signal.source_id);
    made_.lines.emplace(signal.source_id, light);
    std::vector<OsmMember> members{{MemberKind::way, light, "refers"}};
    const auto line = first_line_of_.find(signal.source_id);  // an element has one line
    if (line != first_line_of_.end()) {
      members.push_back({MemberKind::way, stop_line(line->second), "ref_line"});
    }
    give(osm_.add_relation(std::move(members),
                           {{"type", "regulatory_element"}, {"subtype", "traffic_light"}}),
         signal.lanes);
  }

  std::uint32_t stop_line(std::size_t index) {
    if (!stop_lines_[index]) {
      const StopLine& line = road_map_.stop_lines()[index];
      stop_lines_[index] = add_line(line.in_map, {{"type", "stop_line"}}, line.source_id);
    }
    return *stop_lines_[index];
  }

  // Signs, lights and stop lines that no regulation names.
  void add_loose() {
    for (const Signal& signal : road_map_.signals()) {
      if (made_.lines.contains(signal.source_id)) continue;
      Attributes tags = {{"type", signal.dynamic ? "traffic_light" : "traffic_sign"},
                         {"subtype", from_lanelet2_ ? signal.subtype : sign_code(signal)}};
      const std::uint32_t line = add_line(face(signal), std::move(tags), signal.source_id);
      made_.lines.emplace(signal.source_id, line);
    }
    for (std::size_t i = 0; i < road_map_.stop_lines().size(); ++i) {
      const auto known = made_.lines.find(road_map_.stop_lines()[i].source_id);
      if (from_lanelet2_ && known != made_.lines.end()) {
        stop_lines_[i] = known->second;
      } else {
        stop_line(i);
      }
    }
  }

  std::uint32_t add_ring(const geometry::Ring& ring, double z_m, Attributes tags, bool closed) {
    std::vector<std::uint32_t> nodes;
    for (const Eigen::Vector2d& point : ring) {
      nodes.push_back(osm_.add_node({point.x(), point.y(), z_m}));
    }
    if (closed) nodes.push_back(nodes.front());
    return osm_.add_way(std::move(nodes), std::move(tags));
  }

  void add_areas() {
    for (const Area& area : road_map_.areas()) {
      for (const geometry::Polygon& polygon : area.in_map) add_area(area, polygon);
    }
  }

  void add_objects() {
    for (const MapObject& object : road_map_.objects()) {
      if (object.outline_in_map.empty() || made_.lines.contains(object.source_id)) continue;
      Attributes tags =
          from_lanelet2_ ? object.attributes : Attributes{{"type", object.type}, {"area", "yes"}};
      add_ring(object.outline_in_map, object.z_m, std::move(tags), false);
    }
  }

  void add_area(const Area& area, const geometry::Polygon& polygon) {
    const Attributes border = {{"type", "virtual"}};
    std::vector<OsmMember> members{
        {MemberKind::way, add_ring(polygon.outer, 0.0, border, true), "outer"}};
    for (const geometry::Ring& hole : polygon.holes) {
      members.push_back({MemberKind::way, add_ring(hole, 0.0, border, true), "inner"});
    }
    Attributes tags{{"type", "multipolygon"}};
    for (const auto& tag : area.attributes) {
      if (from_lanelet2_ && tag.first != "type") tags.push_back(tag);
    }
    if (!from_lanelet2_) tags.emplace_back("subtype", area.is_road ? "road" : area.type);
    osm_.add_relation(std::move(members), std::move(tags), osm_.keep(area.source_id));
  }

  const RoadMap& road_map_;
  const bool from_lanelet2_;
  LaneletMap& made_;
  OsmMap& osm_;
  std::vector<std::optional<std::uint32_t>> stop_lines_;
  std::map<std::string, std::size_t> first_line_of_;  // by the signal's id
};

}  // namespace

void add_furniture(const RoadMap& road_map, const LaneletChoices& choices, LaneletMap& made) {
  FurnitureMaker(road_map, made).make(choices);
}

}  // namespace roadbed::map::lanelet2
