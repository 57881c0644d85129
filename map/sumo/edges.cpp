#include <fmt/format.h>

#include <algorithm>
#include <optional>

#include "roadbed/map/sumo/net.h"

namespace roadbed::map::sumo {
namespace {

constexpr double kSameBorder_m = 0.5;    // how far apart ends of a border that is shared may be
constexpr double kEnd_m = 1.0;           // of a lane inside a junction that leads nowhere
constexpr std::size_t kMostLanes = 100;  // side by side

Eigen::Vector2d end_of(const LaneLine& line, bool last) {
  return last ? line.in_map.points().back() : line.in_map.points().front();
}

/// Which part of a lane is an edge.
enum class Part { whole, first_metre, last_metre, none };

class EdgeMaker {
 public:
  EdgeMaker(const RoadMap& road_map, const DirectedLanes& ways,
            const std::vector<std::optional<std::uint32_t>>& inner, bool left_hand)
      : road_map_(road_map), ways_(ways), inner_(inner), left_hand_(left_hand) {}

  std::vector<NetEdge> make() {
    for (const Part part : {Part::whole, Part::first_metre, Part::last_metre}) add_all(part);
    return std::move(edges_);
  }

 private:
  void add_all(Part part) {
    std::vector<bool> is_done(road_map_.lanes().size());
    for (const Lane& lane : road_map_.lanes()) {
      if (is_done[lane.id.index] || !has(lane.id, part)) continue;
      std::vector<LaneId> group = beside(lane.id);
      std::erase_if(group, [&](LaneId id) { return is_done[id.index] || !has(id, part); });
      for (const LaneId id : group) is_done[id.index] = true;
      add(group, false, part);
      add(group, true, part);
    }
  }

  bool has(LaneId lane, Part part) const {
    return part_of({lane, false}) == part || part_of({lane, true}) == part;
  }

  Part part_of(DirectedLane way) const {
    if (!ways_.has(way)) return Part::none;
    if (!inner_[way.lane.index]) return Part::whole;
    if (ways_.before(way).empty()) return Part::first_metre;
    return ways_.next(way).empty() ? Part::last_metre : Part::none;
  }

  // The lane and all those beside it that drive its way, from right to left; those that SUMO does
  // not have may lie in between.
  std::vector<LaneId> beside(LaneId lane) const {
    std::vector<LaneId> group{lane};
    for (const bool to_left : {false, true}) {
      while (group.size() < kMostLanes) {
        const auto next = neighbour(to_left ? group.back() : group.front(), to_left);
        if (!next || std::find(group.begin(), group.end(), *next) != group.end()) break;
        group.insert(to_left ? group.end() : group.begin(), *next);
      }
    }
    return group;
  }

  // The lane beside one, if it drives the same way, knows of it, too, and begins and ends there.
  std::optional<LaneId> neighbour(LaneId lane, bool to_left) const {
    const LaneLinks& links = road_map_.graph().of(lane);
    const auto& link = to_left ? links.left : links.right;
    if (!link || !link->same_direction) return {};
    const LaneLinks& back_links = road_map_.graph().of(link->lane);
    const auto& back = to_left ? back_links.right : back_links.left;
    if (!back || back->lane != lane) return {};
    const Lane &a = road_map_.lane(lane), &b = road_map_.lane(link->lane);
    for (const bool last : {false, true}) {
      const Eigen::Vector2d of_a = end_of(to_left ? a.left : a.right, last);
      const Eigen::Vector2d of_b = end_of(to_left ? b.right : b.left, last);
      if ((of_a - of_b).norm() > kSameBorder_m) return {};
    }
    return link->lane;
  }

  // An edge of a group from right to left. Who drives against it has its left to the right, and
  // left is the kerb in left-hand traffic.
  void add(std::vector<LaneId> group, bool against, Part part) {
    if (against != left_hand_) std::reverse(group.begin(), group.end());
    NetEdge edge;
    for (const LaneId id : group) {
      if (part_of({id, against}) == part) edge.lanes.push_back({id, against});
    }
    if (edge.lanes.empty()) return;
    const double share = kEnd_m / road_map_.lane(edge.lanes.front().lane).length_m();
    if (part == Part::first_metre) edge.to_share = share;
    if (part == Part::last_metre) edge.from_share = 1.0 - share;
    edge.id = ids_.give(name(edge.lanes.front()));
    edges_.push_back(std::move(edge));
  }

  // OpenDRIVE: "12", "12/0" where the road has several sections; "-" before what drives against s.
  // Else the name of the lane at the kerb; "-" before one that is driven against its direction.
  std::string name(DirectedLane way) const {
    const Lane& lane = road_map_.lane(way.lane);
    if (!lane.road) return (way.against ? "-" : "") + lane.name;
    const Road& road = road_map_.road(*lane.road);
    const bool along_s = (lane.origin.road_from_s_m <= lane.origin.road_to_s_m) != way.against;
    const bool has_sections = std::any_of(road.lanes.begin(), road.lanes.end(), [&](LaneId id) {
      return road_map_.lane(id).origin.section > 0;
    });
    return fmt::format("{}{}{}", along_s ? "" : "-", road.source_id,
                       has_sections ? fmt::format("/{}", lane.origin.section) : "");
  }

  const RoadMap& road_map_;
  const DirectedLanes& ways_;
  const std::vector<std::optional<std::uint32_t>>& inner_;
  bool left_hand_;
  std::vector<NetEdge> edges_;
  NetIds ids_;
};

}  // namespace

std::string NetIds::give(std::string_view wanted) {
  std::string id;
  for (const char c : wanted) {
    const bool is_plain = (c >= '0' && c <= '9') || (c >= 'a' && c <= 'z') ||
                          (c >= 'A' && c <= 'Z') || c == '.' || c == '/' || c == '+';
    id += is_plain ? c : '-';
  }
  if (id.empty()) id = "-";
  std::string given = id;
  while (taken_.contains(given)) given = fmt::format("{}.{}", id, ++taken_[id]);
  taken_.emplace(given, 1);
  return given;
}

std::vector<NetEdge> make_edges(const RoadMap& road_map, const DirectedLanes& ways,
                                const std::vector<std::optional<std::uint32_t>>& inner,
                                bool left_hand) {
  return EdgeMaker(road_map, ways, inner, left_hand).make();
}

}  // namespace roadbed::map::sumo
