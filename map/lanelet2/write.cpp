#include "roadbed/map/lanelet2/write.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <map>

#include "roadbed/map/files/input_error.h"
#include "roadbed/map/lanelet2/centreline.h"
#include "roadbed/map/lanelet2/frame.h"
#include "roadbed/map/lanelet2/osm_text.h"
#include "roadbed/map/lanelet2/shared_borders.h"
#include "roadbed/map/lanelet2/tags.h"

namespace roadbed::map::lanelet2 {
namespace {

using Line3 = std::vector<Eigen::Vector3d>;

constexpr double kCentreline_m = 1e-3;  // a centreline this near to Lanelet2's own is not written

TransverseMercator grid_of(const std::string& crs) {
  if (const auto grid = transverse_mercator_of(crs)) return *grid;
  throw InputError(
      {.file = "Lanelet2",
       .found = crs.empty()
                    ? "the map's CRS is unknown"
                    : fmt::format("the map's CRS \"{}\" is no transverse Mercator one", crs),
       .needed = "latitude and longitude of its nodes",
       .remedy = "give --anchor LAT,LON: where its coordinates 0,0 are"});
}

class Lanelet2Writer {
 public:
  Lanelet2Writer(const RoadMap& road_map, const Lanelet2Options& options)
      : road_map_(road_map),
        from_lanelet2_(road_map.format() == "Lanelet2"),
        shared_(share_borders(road_map)),
        text_(road_map, options.crs, options.offset_in_crs, grid_of(options.crs)) {}

  Lanelet2File write() {
    name_lanes();
    write_borders();
    write_regulations();
    write_loose_signals();
    write_areas();
    write_lanelets();
    Lanelet2File file;
    file.bytes = text_.file();
    file.notes = notes();
    return file;
  }

 private:
  void name_lanes() {
    lane_ids_.resize(road_map_.lanes().size());
    for (const Lane& lane : road_map_.lanes()) {
      if (from_lanelet2_ || is_writable(lane)) {
        lane_ids_[lane.id.index] = text_.keep(lane.name);
      } else {
        ++left_out_;
      }
    }
  }

  std::int64_t add_line(const Line3& line, const Attributes& tags, const std::string& source_id) {
    const std::int64_t id = from_lanelet2_ ? text_.keep(source_id) : text_.fresh();
    std::vector<std::int64_t> nodes;
    for (const Eigen::Vector3d& point : line) nodes.push_back(text_.add_node(point));
    text_.add_way(id, nodes, tags);
    return id;
  }

  // Borders: the lines that a written lane uses, their marking and what it has to allow.
  struct LineUse {
    bool used = false;
    std::optional<BorderMark> mark;
    CrossingWish wish;
  };

  std::vector<LineUse> uses() const {
    std::vector<LineUse> uses(shared_.lines.size());
    for (const Lane& lane : road_map_.lanes()) {
      if (!lane_ids_[lane.id.index]) continue;
      const LaneLinks& links = road_map_.graph().of(lane.id);
      for (const int side : {0, 1}) {
        const SharedBorders::Side& border =
            shared_.lanes[lane.id.index][static_cast<std::size_t>(side)];
        LineUse& use = uses[border.line];
        use.used = true;
        const auto mark =
            longest_mark(side == 0 ? lane.left_marks : lane.right_marks, lane.length_m());
        if (mark && !use.mark) use.mark = border.reversed ? turned(*mark) : *mark;
        const auto& neighbour = side == 0 ? links.left : links.right;
        if (neighbour) wish(use.wish, lane, *neighbour, (side == 0) != border.reversed);
      }
    }
    return uses;
  }

  static std::optional<BorderMark> longest_mark(const std::vector<BorderMark>& marks,
                                                double length_m) {
    std::optional<BorderMark> longest;
    double most_m = -1.0;
    for (std::size_t i = 0; i < marks.size(); ++i) {
      const double to_m = i + 1 < marks.size() ? marks[i + 1].from_s_m : length_m;
      if (to_m - marks[i].from_s_m > most_m) {
        most_m = to_m - marks[i].from_s_m;
        longest = marks[i];
      }
    }
    return longest;
  }

  void wish(CrossingWish& wish, const Lane& lane, const Neighbour& neighbour, bool to_left) const {
    const Participants others = road_map_.lane(neighbour.lane).participants;
    if ((lane.participants.bits() & others.bits()) == 0) return;
    std::optional<bool>& asked = to_left ? wish.to_left : wish.to_right;
    asked = asked.value_or(false) || neighbour.change_allowed();
  }

  void write_borders() {
    std::vector<std::optional<std::int64_t>> node_ids(shared_.points.size());
    line_ids_.resize(shared_.lines.size());
    const std::vector<LineUse> all = uses();
    for (std::size_t i = 0; i < shared_.lines.size(); ++i) {
      if (!all[i].used) continue;
      std::vector<std::int64_t> nodes;
      for (const std::uint32_t point : shared_.lines[i]) {
        if (!node_ids[point]) node_ids[point] = text_.add_node(shared_.points[point]);
        nodes.push_back(*node_ids[point]);
      }
      line_ids_[i] = text_.fresh();
      text_.add_way(line_ids_[i], nodes, border_tags(all[i].mark, all[i].wish));
    }
  }

  Line3 border_points(LaneId lane, std::size_t side) const {
    const SharedBorders::Side& border = shared_.lanes[lane.index][side];
    Line3 points;
    for (const std::uint32_t point : shared_.lines[border.line]) {
      points.push_back(shared_.points[point]);
    }
    if (border.reversed) std::reverse(points.begin(), points.end());
    return points;
  }

  // The lane's centreline, where Lanelet2 would not come to the same by itself.
  std::optional<std::int64_t> centreline_of(const Lane& lane) {
    const Line3 own =
        centreline_between(border_points(lane.id, 0), border_points(lane.id, 1)).points;
    std::vector<Eigen::Vector2d> plan;
    for (const Eigen::Vector3d& point : own) plan.emplace_back(point.head<2>());
    const geometry::Polyline line(std::move(plan));
    const auto& points = lane.centre.in_map.points();
    const bool agrees = std::all_of(points.begin(), points.end(), [&](const Eigen::Vector2d& p) {
      return std::abs(line.project(p).d_m) <= kCentreline_m;
    });
    if (agrees) return {};
    Line3 centre;
    for (std::size_t i = 0; i < points.size(); ++i) {
      centre.emplace_back(points[i].x(), points[i].y(), lane.centre.z_m[i]);
    }
    const std::int64_t id = text_.fresh();
    std::vector<std::int64_t> nodes;
    for (const Eigen::Vector3d& point : centre) nodes.push_back(text_.add_node(point));
    text_.add_way(id, nodes, {{"type", "centerline"}});
    return id;
  }

  void write_lanelets() {
    for (const Lane& lane : road_map_.lanes()) {
      if (!lane_ids_[lane.id.index]) continue;
      const auto& sides = shared_.lanes[lane.id.index];
      std::string members = OsmText::member("way", line_ids_[sides[0].line], "left") +
                            OsmText::member("way", line_ids_[sides[1].line], "right");
      if (const auto centre = centreline_of(lane)) {
        members += OsmText::member("way", *centre, "centerline");
      }
      for (const std::int64_t id : regulations_of_lane_[lane.id.index]) {
        members += OsmText::member("relation", id, "regulatory_element");
      }
      text_.add_relation(*lane_ids_[lane.id.index], members, lanelet_tags(lane, from_lanelet2_));
    }
  }

  // Lines and points that regulations name are written once, whoever names them.
  std::optional<std::string> member_of(const RegulationMember& member) {
    if (member.lane) {
      const auto& id = lane_ids_[member.lane->index];
      return id ? std::optional(OsmText::member("relation", *id, member.role)) : std::nullopt;
    }
    if (member.in_map.empty()) return {};
    const bool is_node = member.in_map.size() == 1;
    const auto known = written_.find(member.source_id);
    const std::int64_t id = known != written_.end() ? known->second
                            : is_node
                                ? text_.add_node(member.in_map.front())
                                : add_line(member.in_map, member.attributes, member.source_id);
    written_.emplace(member.source_id, id);
    return OsmText::member(is_node ? "node" : "way", id, member.role);
  }

  void write_regulations() {
    if (from_lanelet2_) {
      for (const Regulation& regulation : road_map_.regulations()) write_kept(regulation);
    } else {
      for (const Signal& signal : road_map_.signals()) {
        if (signal.dynamic) write_light(signal);
      }
    }
  }

  // A regulatory element as it was read.
  void write_kept(const Regulation& regulation) {
    std::string members;
    for (const RegulationMember& member : regulation.members) {
      if (const auto line = member_of(member)) members += *line;
    }
    finish_regulation(text_.keep(regulation.source_id), members, regulation.attributes,
                      regulation.lanes);
  }

  void finish_regulation(std::int64_t id, const std::string& members, const Attributes& tags,
                         const std::vector<LaneId>& lanes) {
    text_.add_relation(id, members, tags);
    for (const LaneId lane : lanes) regulations_of_lane_[lane.index].push_back(id);
  }

  // A light's face as a line across the direction in which it looks.
  static Line3 face(const Signal& signal) {
    constexpr double half_width_m = 0.15;
    const double heading_rad = signal.heading_rad.value_or(0.0);
    const Eigen::Vector2d across(-std::sin(heading_rad), std::cos(heading_rad));
    const Eigen::Vector2d a = signal.in_map + half_width_m * across;
    const Eigen::Vector2d b = signal.in_map - half_width_m * across;
    // Whoever looks at the face has `a` at the right: the line runs from left to right for him.
    return {{b.x(), b.y(), signal.z_m}, {a.x(), a.y(), signal.z_m}};
  }

  void write_light(const Signal& signal) {
    const bool speaks = std::any_of(signal.lanes.begin(), signal.lanes.end(),
                                    [&](LaneId lane) { return lane_ids_[lane.index].has_value(); });
    if (!speaks || written_.contains(signal.source_id)) return;
    const std::int64_t light =
        add_line(face(signal), {{"type", "traffic_light"}, {"subtype", "red_yellow_green"}},
                 signal.source_id);
    written_.emplace(signal.source_id, light);
    std::string members = OsmText::member("way", light, "refers");
    for (const StopLine& line : road_map_.stop_lines()) {
      if (std::find(line.signals.begin(), line.signals.end(), signal.source_id) ==
          line.signals.end()) {
        continue;
      }
      members += OsmText::member("way", stop_line_id(line), "ref_line");
      break;  // an element has one line
    }
    finish_regulation(text_.fresh(), members,
                      {{"type", "regulatory_element"}, {"subtype", "traffic_light"}}, signal.lanes);
  }

  std::int64_t stop_line_id(const StopLine& line) {
    const auto known = stop_line_ids_.find(&line);
    if (known != stop_line_ids_.end()) return known->second;
    const std::int64_t id = add_line(line.in_map, {{"type", "stop_line"}}, line.source_id);
    stop_line_ids_.emplace(&line, id);
    return id;
  }

  // Signs, lights and stop lines that no regulation names.
  void write_loose_signals() {
    for (const Signal& signal : road_map_.signals()) {
      if (written_.contains(signal.source_id)) continue;
      Attributes tags = {{"type", signal.dynamic ? "traffic_light" : "traffic_sign"},
                         {"subtype", from_lanelet2_ ? signal.subtype : sign_code(signal)}};
      written_.emplace(signal.source_id, add_line(face(signal), tags, signal.source_id));
    }
    for (const StopLine& line : road_map_.stop_lines()) {
      if (!(from_lanelet2_ && written_.contains(line.source_id))) stop_line_id(line);
    }
  }

  static std::string sign_code(const Signal& signal) {
    std::string code;
    for (const char c : signal.country) {
      code += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    }
    code += signal.type;
    if (!signal.subtype.empty() && signal.subtype != "-1") code += "-" + signal.subtype;
    return code;
  }

  std::int64_t add_ring(const geometry::Ring& ring, double z_m, Attributes tags, bool closed) {
    std::vector<std::int64_t> nodes;
    for (const Eigen::Vector2d& point : ring)
      nodes.push_back(text_.add_node({point.x(), point.y(), z_m}));
    if (closed) nodes.push_back(nodes.front());
    const std::int64_t id = text_.fresh();
    text_.add_way(id, nodes, tags);
    return id;
  }

  void write_areas() {
    for (const Area& area : road_map_.areas()) {
      for (const geometry::Polygon& polygon : area.in_map) {
        const Attributes border = {{"type", "virtual"}};
        std::string members =
            OsmText::member("way", add_ring(polygon.outer, 0.0, border, true), "outer");
        for (const geometry::Ring& hole : polygon.holes) {
          members += OsmText::member("way", add_ring(hole, 0.0, border, true), "inner");
        }
        Attributes tags{{"type", "multipolygon"}};
        for (const auto& tag : area.attributes) {
          if (from_lanelet2_ && tag.first != "type") tags.push_back(tag);
        }
        if (!from_lanelet2_) tags.emplace_back("subtype", area.is_road ? "road" : area.type);
        text_.add_relation(text_.keep(area.source_id), members, tags);
      }
    }
    for (const MapObject& object : road_map_.objects()) {
      if (object.outline_in_map.empty() || written_.contains(object.source_id)) continue;
      Attributes tags =
          from_lanelet2_ ? object.attributes : Attributes{{"type", object.type}, {"area", "yes"}};
      add_ring(object.outline_in_map, object.z_m, std::move(tags), false);
    }
  }

  std::vector<std::string> notes() const {
    std::vector<std::string> notes;
    const auto note = [&](std::size_t count, const char* what) {
      if (count > 0) notes.push_back(fmt::format("{} {}", count, what));
    };
    note(left_out_, "lanes that nobody may use are left out");
    note(shared_.lost_links, "links are lost: their lanes' ends are too far apart to be one");
    note(shared_.unwanted_links, "lanes begin where another one ends and now follow it");
    if (shared_.largest_move_m > 1e-3) {
      notes.push_back(fmt::format("ends of linked lanes were joined and moved by up to {:.3f} m",
                                  shared_.largest_move_m));
    }
    return notes;
  }

  const RoadMap& road_map_;
  const bool from_lanelet2_;
  const SharedBorders shared_;
  OsmText text_;
  std::vector<std::optional<std::int64_t>> lane_ids_;  // by LaneId; none: left out
  std::vector<std::int64_t> line_ids_;                 // by line of shared_
  std::map<std::string, std::int64_t> written_;        // lines of regulations and signals
  std::map<const StopLine*, std::int64_t> stop_line_ids_;
  std::map<std::uint32_t, std::vector<std::int64_t>> regulations_of_lane_;
  std::size_t left_out_ = 0;
};

}  // namespace

Lanelet2File write_lanelet2(const RoadMap& road_map, const Lanelet2Options& options) {
  return Lanelet2Writer(road_map, options).write();
}

Lanelet2File write_lanelet2(const RoadMap& road_map) {
  return write_lanelet2(road_map, {road_map.crs(), road_map.offset_in_crs()});
}

}  // namespace roadbed::map::lanelet2
