#include "roadbed/map/lanelet2/write/autoware/lane_tags.h"

#include <algorithm>
#include <map>
#include <optional>
#include <string_view>
#include <utility>
#include <vector>

#include "roadbed/map/lanelet2/traffic_rules.h"

namespace roadbed::map::lanelet2 {
namespace {

bool is_road(const Lane& lane) {
  return is_drivable(lane.type) || lane.type == LaneType::bus || lane.type == LaneType::taxi;
}

bool is_beside_road(const Lane& lane) {
  return lane.type == LaneType::shoulder || lane.type == LaneType::stop ||
         lane.type == LaneType::parking;
}

/// Whether a road lies on that side of a lane; of a shoulder, beyond other shoulders too.
bool leads_to_road(const RoadMap& road_map, const Lane& lane,
                   std::optional<Neighbour> LaneLinks::*side) {
  constexpr int kMost = 64;
  const Lane* at = &lane;
  for (int i = 0; i < kMost; ++i) {
    const auto& neighbour = road_map.graph().of(at->id).*side;
    if (!neighbour) return false;
    at = &road_map.lane(neighbour->lane);
    if (is_road(*at)) return true;
    if (!is_beside_road(*at) || !is_beside_road(lane)) return false;
  }
  return false;
}

/// Autoware's word for the subtype of a lane that is not Lanelet2's.
std::string_view subtype_of(LaneType type) {
  switch (type) {
    case LaneType::biking:
      return "bicycle_lane";
    case LaneType::sidewalk:
      return "pedestrian_lane";
    case LaneType::shoulder:
    case LaneType::stop:
    case LaneType::parking:
      return "road_shoulder";
    default:
      return "road";
  }
}

/// A side of a lanelet that lies on a way.
struct Use {
  std::uint32_t lane = 0;
  std::size_t side = 0;  ///< 0 left, 1 right
  bool reversed = false;
};

class LaneTagger {
 public:
  LaneTagger(const RoadMap& road_map, LaneletMap& made) : road_map_(road_map), made_(made) {}

  void add() {
    for (const Lane& lane : road_map_.lanes()) {
      if (made_.lanelets[lane.id.index]) add_tags(lane);
    }
    for (const auto& [way, uses] : uses_of_ways()) {
      part_from_walkways(way, uses);
      mark_outer_border(way, uses);
      say_lane_change(way, uses);
    }
  }

 private:
  void add_tags(const Lane& lane) {
    Attributes& tags = made_.tags_of(lane.id);
    if (!is_from_lanelet2(road_map_)) set_tag(tags, "subtype", subtype_of(lane.type));
    const std::string_view subtype = tag_of(tags, "subtype");
    if (subtype == "road") add_road_tags(lane, tags);
    // Of a shoulder Lanelet2 would make a lane to drive on.
    if (subtype == "road_shoulder") return;
    const bool names_users = std::ranges::any_of(
        tags, [](const auto& tag) { return tag.first.starts_with("participant:"); });
    if (!names_users && !lane.participants.empty()) add_participants(lane.participants, tags);
  }

  static void add_road_tags(const Lane& lane, Attributes& tags) {
    const std::string_view location = tag_of(tags, "location");
    // Where no limit is given, Lanelet2 takes it from the location.
    const bool has_limit = !tag_of(tags, "speed_limit").empty();
    if (location.empty() || (location == "nonurban" && has_limit)) {
      set_tag(tags, "location", "urban");
    }
    if (lane.one_way) set_tag(tags, "one_way", "yes");
  }

  std::map<std::uint32_t, std::vector<Use>> uses_of_ways() const {
    std::map<std::uint32_t, std::vector<Use>> uses;
    for (std::uint32_t lane = 0; lane < made_.borders.size(); ++lane) {
      if (!made_.lanelets[lane]) continue;
      for (const std::size_t side : {0U, 1U}) {
        const Border& border = made_.borders[lane][side];
        uses[border.way].push_back({lane, side, border.reversed});
      }
    }
    return uses;
  }

  std::string_view subtype(const Use& use) const {
    return tag_of(made_.tags_of(LaneId{use.lane}), "subtype");
  }

  bool is_walked(const Use& use) const {
    const std::string_view type = subtype(use);
    return type == "walkway" || type == "crosswalk";
  }

  /// A walkway or crosswalk gets a line of its own, where vehicles are on the other side.
  void part_from_walkways(std::uint32_t way, const std::vector<Use>& uses) {
    const auto walked = std::ranges::count_if(uses, [&](const Use& use) { return is_walked(use); });
    if (walked == 0 || walked == std::ssize(uses)) return;
    std::vector<std::uint32_t> nodes;
    for (const Eigen::Vector3d& point : made_.osm.points(way)) {
      nodes.push_back(made_.osm.add_node(point));
    }
    const std::uint32_t own = made_.osm.add_way(std::move(nodes), made_.osm.ways[way].tags);
    for (const Use& use : uses) {
      if (is_walked(use)) replace(use, own);
    }
  }

  void replace(const Use& use, std::uint32_t own) {
    Border& border = made_.borders[use.lane][use.side];
    OsmRelation& lanelet = made_.osm.relations[*made_.lanelets[use.lane]];
    for (OsmMember& member : lanelet.members) {
      const bool is_side = member.role == (use.side == 0 ? "left" : "right");
      if (is_side && member.kind == MemberKind::way && member.index == border.way) {
        member.index = own;
      }
    }
    border.way = own;
  }

  void mark_outer_border(std::uint32_t way, const std::vector<Use>& uses) {
    if (uses.size() != 1) return;
    const std::string_view type = subtype(uses.front());
    if (type != "road_shoulder" && type != "pedestrian_lane") return;
    Attributes& tags = made_.osm.ways[way].tags;
    set_tag(tags, "type", "road_border");
    remove_tag(tags, "subtype");
  }

  /// Said for both directions at once; a line that may be crossed from one side keeps its own tags.
  void say_lane_change(std::uint32_t way, const std::vector<Use>& uses) {
    const auto lies = [&](std::size_t side) {
      return std::ranges::any_of(uses, [&](const Use& use) {
        return use.side == side && subtype(use) == "road" && use.reversed == uses[0].reversed;
      });
    };
    if (!lies(0) || !lies(1)) return;
    Attributes& tags = made_.osm.ways[way].tags;
    if (!tag_of(tags, "lane_change").empty()) return;
    const CrossingRule rule = crossing_rule(views_of(tags), Participants::vehicles());
    if (rule.to_left != rule.to_right) return;
    remove_tag(tags, "lane_change:left");
    remove_tag(tags, "lane_change:right");
    set_tag(tags, "lane_change", rule.to_left ? "yes" : "no");
  }

  const RoadMap& road_map_;
  LaneletMap& made_;
};

}  // namespace

bool has_place_in_autoware(const RoadMap& road_map, const Lane& lane) {
  if (!is_writable(lane) || lane.type == LaneType::tram || lane.type == LaneType::rail) {
    return false;
  }
  const bool needs_road = lane.type == LaneType::sidewalk || is_beside_road(lane);
  return !needs_road || leads_to_road(road_map, lane, &LaneLinks::left) ||
         leads_to_road(road_map, lane, &LaneLinks::right);
}

void add_lane_tags(const RoadMap& road_map, LaneletMap& made) { LaneTagger(road_map, made).add(); }

}  // namespace roadbed::map::lanelet2
