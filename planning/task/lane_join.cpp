#include "roadbed/planning/task/lane_join.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "roadbed/geometry/primitives/angle.h"
#include "roadbed/map/derived/conflicts.h"
#include "roadbed/map/derived/rule_index.h"
#include "roadbed/planning/task/give_way_rules.h"

namespace roadbed::planning::inline task {
namespace {

constexpr double kJoinsAlong_rad = 0.8, kStraighter_rad = 0.05;

class Join {
 public:
  Join(const map::RoadMap& road_map, map::LaneId own, map::LaneId other)
      : road_map_(road_map), own_(own), other_(other), rules_(road_map, with_predecessors()) {}

  bool is_along() const {
    const double apart = geometry::wrap_angle(start_rad(own_) - start_rad(other_));
    return std::abs(apart) < kJoinsAlong_rad;
  }

  bool own_gives_way() const {
    if (yields_by_regulation(own_, other_)) return true;
    if (yields_by_regulation(other_, own_) || has_sign(other_)) return false;
    if (lanes_before(own_) != lanes_before(other_))
      return lanes_before(own_) < lanes_before(other_);
    const double more_rad = turned_rad(own_) - turned_rad(other_);
    return std::abs(more_rad) > kStraighter_rad ? more_rad > 0.0 : other_is_right();
  }

 private:
  std::vector<map::LaneId> with_predecessors() const {
    std::vector<map::LaneId> lanes{own_, other_};
    for (const map::LaneId lane : {own_, other_}) {
      const auto& before = road_map_.graph().of(lane).predecessors;
      lanes.insert(lanes.end(), before.begin(), before.end());
    }
    return lanes;
  }

  double start_rad(map::LaneId lane) const { return road_map_.lane(lane).pose_at(0.0).heading_rad; }

  double turned_rad(map::LaneId id) const {
    const map::Lane& lane = road_map_.lane(id);
    const double end_rad = lane.pose_at(lane.length_m()).heading_rad;
    return std::abs(geometry::wrap_angle(end_rad - start_rad(id)));
  }

  bool yields_by_regulation(map::LaneId lane, map::LaneId to) const {
    return std::ranges::any_of(road_map_.regulations(), [&](const map::Regulation& regulation) {
      return has_priority_role(regulation, "yield", lane) &&
             has_priority_role(regulation, "right_of_way", to);
    });
  }

  bool has_sign(map::LaneId lane) const {
    std::vector<map::LaneId> lanes = road_map_.graph().of(lane).predecessors;
    lanes.push_back(lane);
    return std::ranges::any_of(
        lanes, [&](map::LaneId id) { return has_sign_to_give_way(road_map_, rules_, id); });
  }

  /// Of its direction, beside the lane that it comes from, that one counted.
  int lanes_before(map::LaneId lane) const {
    const auto& before = road_map_.graph().of(lane).predecessors;
    if (before.empty()) return 1;
    int count = 1;
    for (const bool left : {true, false}) {
      map::LaneId at = before.front();
      for (std::size_t i = 0; i < road_map_.lanes().size(); ++i) {
        const map::LaneLinks& links = road_map_.graph().of(at);
        const std::optional<map::Neighbour>& next = left ? links.left : links.right;
        if (!next || !next->same_direction) break;
        if (!map::is_drivable(road_map_.lane(next->lane).type)) break;
        at = next->lane;
        ++count;
      }
    }
    return count;
  }

  bool other_is_right() const {
    const Eigen::Vector2d from = road_map_.lane(own_).pose_at(0.0).position();
    const Eigen::Vector2d beside = road_map_.lane(other_).pose_at(0.0).position() - from;
    return std::cos(start_rad(own_)) * beside.y() < std::sin(start_rad(own_)) * beside.x();
  }

  const map::RoadMap& road_map_;
  map::LaneId own_, other_;
  map::RuleIndex rules_;
};

bool is_joined(const map::RoadMap& road_map, map::LaneId lane) {
  return std::ranges::any_of(road_map.graph().of(lane).successors, [&](map::LaneId next) {
    return road_map.graph().of(next).predecessors.size() > 1;
  });
}

}  // namespace

std::optional<LaneJoin> join_to_give_way_at(const map::RoadMap& road_map, map::LaneId lane) {
  if (!is_joined(road_map, lane)) return std::nullopt;
  std::optional<LaneJoin> first;
  for (const map::Conflict& conflict : map::find_conflicts_of(road_map, lane)) {
    if (conflict.kind != map::ConflictKind::merging) continue;
    const map::LaneId other = conflict.partner_of(lane);
    const Join join(road_map, lane, other);
    if (!join.is_along() || !join.own_gives_way()) continue;
    const double from_s_m = conflict.on(lane).from_s_m;
    if (!first || from_s_m < first->from_s_m) first = LaneJoin{other, from_s_m};
  }
  return first;
}

}  // namespace roadbed::planning::task
