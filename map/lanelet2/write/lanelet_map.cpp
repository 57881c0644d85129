#include "roadbed/map/lanelet2/write/lanelet_map.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "roadbed/geometry/index/line_distance.h"
#include "roadbed/map/files/input_error.h"
#include "roadbed/map/lanelet2/centreline.h"
#include "roadbed/map/lanelet2/write/shared_borders.h"

namespace roadbed::map::lanelet2 {
namespace {

using Line3 = std::vector<Eigen::Vector3d>;

constexpr double kCentreline_m = 1e-3;  // a centreline this near to Lanelet2's own is not written

std::optional<BorderMark> longest_mark(const std::vector<BorderMark>& marks, double length_m) {
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

class LaneletMapMaker {
 public:
  LaneletMapMaker(const RoadMap& road_map, const LaneletChoices& choices)
      : road_map_(road_map),
        choices_(choices),
        from_lanelet2_(is_from_lanelet2(road_map)),
        shared_(share_borders(road_map,
                              {.counts = [this](const Lane& lane) { return is_written(lane); }})),
        made_(id_beyond_all(road_map)) {}

  LaneletMap make() {
    name_lanes();
    straighten_folded_borders();
    add_borders();
    for (const Lane& lane : road_map_.lanes()) {
      if (made_.lanelets[lane.id.index]) fill(lane);
    }
    made_.lost_links = shared_.lost_links;
    made_.unwanted_links = shared_.unwanted_links;
    made_.largest_move_m = shared_.largest_move_m;
    made_.largest_step_m = shared_.largest_step_m;
    return std::move(made_);
  }

 private:
  bool is_written(const Lane& lane) const { return from_lanelet2_ || choices_.is_wanted(lane); }

  void name_lanes() {
    made_.lanelets.resize(road_map_.lanes().size());
    for (const Lane& lane : road_map_.lanes()) {
      if (is_written(lane)) {
        made_.lanelets[lane.id.index] = made_.osm.add_relation({}, {}, made_.osm.keep(lane.name));
      } else {
        ++made_.left_out;
      }
    }
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
      if (!made_.lanelets[lane.id.index]) continue;
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

  void wish(CrossingWish& wish, const Lane& lane, const Neighbour& neighbour, bool to_left) const {
    const Participants others = road_map_.lane(neighbour.lane).participants;
    if ((lane.participants.bits() & others.bits()) == 0) return;
    std::optional<bool>& asked = to_left ? wish.to_left : wish.to_right;
    asked = asked.value_or(false) || neighbour.change_allowed();
  }

  void add_borders() {
    std::vector<std::optional<std::uint32_t>> node_of(shared_.points.size());
    std::vector<std::uint32_t> way_of(shared_.lines.size());
    const std::vector<LineUse> all = uses();
    for (std::size_t i = 0; i < shared_.lines.size(); ++i) {
      if (!all[i].used) continue;
      std::vector<std::uint32_t> nodes;
      for (const std::uint32_t point : shared_.lines[i]) {
        if (!node_of[point]) node_of[point] = made_.osm.add_node(shared_.points[point]);
        nodes.push_back(*node_of[point]);
      }
      way_of[i] = made_.osm.add_way(std::move(nodes), border_tags(all[i].mark, all[i].wish));
    }
    for (const auto& sides : shared_.lanes) {
      made_.borders.push_back({Border{way_of[sides[0].line], sides[0].reversed},
                               Border{way_of[sides[1].line], sides[1].reversed}});
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

  /// Lanelet2 sees by the shape of two borders which way they run. Where the inner one of a narrow
  /// bend folds over itself, it would be seen backwards: it goes straight from end to end.
  void straighten_folded_borders() {
    for (const Lane& lane : road_map_.lanes()) {
      if (!made_.lanelets[lane.id.index] || is_seen_rightly(lane.id)) continue;
      const auto& [left, right] = shared_.lanes[lane.id.index];
      if (straightened(lane.id, {left.line}) || straightened(lane.id, {right.line})) continue;
      straightened(lane.id, {left.line, right.line});
    }
  }

  /// Straightens lines where a lane is seen rightly by it.
  bool straightened(LaneId lane, const std::vector<std::uint32_t>& lines) {
    std::vector<std::vector<std::uint32_t>> folded;
    for (const std::uint32_t line : lines) {
      std::vector<std::uint32_t>& points = shared_.lines[line];
      folded.push_back(std::exchange(points, {points.front(), points.back()}));
    }
    if (is_seen_rightly(lane)) {
      made_.straightened += lines.size();
      return true;
    }
    for (std::size_t i = 0; i < lines.size(); ++i) {
      shared_.lines[lines[i]] = std::move(folded[i]);
    }
    return false;
  }

  bool is_seen_rightly(LaneId lane) const {
    const Alignment seen = align(border_points(lane, 0), border_points(lane, 1));
    return !seen.left_reversed && !seen.right_reversed;
  }

  // The lane's centreline, where Lanelet2 would not come to the same by itself.
  std::optional<std::uint32_t> centreline_of(const Lane& lane) {
    const Line3 own =
        centreline_between(border_points(lane.id, 0), border_points(lane.id, 1)).points;
    std::vector<Eigen::Vector2d> plan;
    for (const Eigen::Vector3d& point : own) plan.emplace_back(point.head<2>());
    const geometry::Polyline line(std::move(plan));
    if (geometry::farthest_m(lane.centre.in_map, line) <= kCentreline_m) return {};
    const auto& points = lane.centre.in_map.points();
    std::vector<std::uint32_t> nodes;
    for (std::size_t i = 0; i < points.size(); ++i) {
      nodes.push_back(made_.osm.add_node({points[i].x(), points[i].y(), lane.centre.z_m[i]}));
    }
    return made_.osm.add_way(std::move(nodes), {{"type", "centerline"}});
  }

  void fill(const Lane& lane) {
    const auto& borders = made_.borders[lane.id.index];
    std::vector<OsmMember> members{{MemberKind::way, borders[0].way, "left"},
                                   {MemberKind::way, borders[1].way, "right"}};
    if (choices_.centrelines || from_lanelet2_) {
      const auto centre = centreline_of(lane);
      if (centre) members.push_back({MemberKind::way, *centre, "centerline"});
    }
    OsmRelation& lanelet = made_.osm.relations[*made_.lanelets[lane.id.index]];
    lanelet.members = std::move(members);
    lanelet.tags = lanelet_tags(lane, from_lanelet2_);
  }

  const RoadMap& road_map_;
  const LaneletChoices& choices_;
  const bool from_lanelet2_;
  SharedBorders shared_;
  LaneletMap made_;
};

}  // namespace

std::map<std::uint32_t, LaneId> LaneletMap::lanes_by_relation() const {
  std::map<std::uint32_t, LaneId> lanes;
  for (std::uint32_t lane = 0; lane < lanelets.size(); ++lane) {
    if (lanelets[lane]) lanes.emplace(*lanelets[lane], LaneId{lane});
  }
  return lanes;
}

LaneletMap lanelet_map(const RoadMap& road_map, const LaneletChoices& choices) {
  LaneletMap made = LaneletMapMaker(road_map, choices).make();
  if (std::ranges::none_of(made.lanelets,
                           [](const auto& lanelet) { return lanelet.has_value(); })) {
    throw InputError({.file = "Lanelet2",
                      .found = fmt::format("none of the map's {} lanes can be a lanelet",
                                           road_map.lanes().size()),
                      .needed = "a lane that somebody may use",
                      .remedy = "export a map that has one, or to another format"});
  }
  add_furniture(road_map, choices, made);
  return made;
}

std::size_t flattened_limits(const RoadMap& road_map, const LaneletMap& made) {
  return static_cast<std::size_t>(std::ranges::count_if(road_map.lanes(), [&](const Lane& lane) {
    return made.lanelets[lane.id.index] && lane.speed_limits.size() > 1;
  }));
}

std::vector<std::string> notes_of(const LaneletMap& made) {
  std::vector<std::string> notes;
  const auto note = [&](std::size_t count, const char* what) {
    if (count > 0) notes.push_back(fmt::format("{} {}", count, what));
  };
  note(made.lost_links, "links are lost: their lanes' ends are too far apart to be one");
  note(made.unwanted_links, "lanes begin where another one ends and now follow it");
  if (made.largest_move_m > 1e-3) {
    notes.push_back(fmt::format("ends of linked lanes were joined and moved by up to {:.3f} m",
                                made.largest_move_m));
  }
  note(made.straightened, "borders that fold over themselves go straight from end to end");
  if (made.largest_step_m > 0.0) {
    notes.push_back(
        fmt::format("borders of linked lanes that do not meet go on by steps of up to {:.3f} m",
                    made.largest_step_m));
  }
  return notes;
}

}  // namespace roadbed::map::lanelet2
