#include <algorithm>
#include <cmath>
#include <map>

#include "roadbed/map/commonroad/plan.h"

namespace roadbed::map::commonroad {
namespace {

constexpr double kTurnRad = 0.7853981633974483;  // 45°

PlannedIncoming& incoming_of(const RegulationMember& member, IdGiver& ids,
                             std::map<std::string, std::size_t>& index,
                             PlannedIntersection& intersection) {
  const std::string source_id = member.attributes.empty() ? "" : member.attributes.front().second;
  const auto [found, is_new] = index.emplace(source_id, intersection.incomings.size());
  if (is_new) intersection.incomings.emplace_back().id = ids.give(source_id);
  return intersection.incomings[found->second];
}

/// CommonRoad's own intersection, as it was read.
PlannedIntersection from_regulation(const Regulation& rule, IdGiver& ids) {
  PlannedIntersection intersection;
  intersection.id = ids.give(rule.source_id);
  std::map<std::string, std::size_t> index;
  for (const RegulationMember& member : rule.members) {
    if (member.role == "crossing" && member.lane) intersection.crossings.push_back(*member.lane);
    if (!member.lane || member.role == "crossing") continue;
    PlannedIncoming& incoming = incoming_of(member, ids, index, intersection);
    if (member.role == "incoming") incoming.lanes.push_back(*member.lane);
    if (member.role == "successors_right") incoming.right.push_back(*member.lane);
    if (member.role == "successors_straight") incoming.straight.push_back(*member.lane);
    if (member.role == "successors_left") incoming.left.push_back(*member.lane);
  }
  for (const RegulationMember& member : rule.members) {
    if (member.role != "is_left_of") continue;
    const auto other = index.find(member.source_id);
    if (other == index.end()) continue;
    incoming_of(member, ids, index, intersection).is_left_of =
        intersection.incomings[other->second].id;
  }
  return intersection;
}

/// The leftmost of the lanes beside this one that lead the same way, this side of the junction.
LaneId leftmost(const RoadMap& road_map, LaneId id) {
  const std::optional<JunctionId> junction = road_map.lane(id).junction;
  for (std::size_t steps = 0; steps < road_map.lanes().size(); ++steps) {
    const std::optional<Neighbour>& left = road_map.graph().of(id).left;
    if (!left || !left->same_direction || road_map.lane(left->lane).junction != junction) break;
    id = left->lane;
  }
  return id;
}

void sort_by_turn(const Lane& lane, PlannedIncoming& incoming) {
  const double turn_rad = lane.pose_at(lane.length_m()).heading_rad - lane.pose_at(0.0).heading_rad;
  const double wrapped_rad = std::remainder(turn_rad, 2.0 * std::acos(-1.0));
  std::vector<LaneId>& way = wrapped_rad > kTurnRad    ? incoming.left
                             : wrapped_rad < -kTurnRad ? incoming.right
                                                       : incoming.straight;
  if (std::find(way.begin(), way.end(), lane.id) == way.end()) way.push_back(lane.id);
}

PlannedIntersection from_junction(const RoadMap& road_map, const Junction& junction,
                                  const std::vector<LaneId>& inside, IdGiver& ids) {
  PlannedIntersection intersection;
  std::map<LaneId, PlannedIncoming> by_leader;
  for (const LaneId id : inside) {
    const Lane& lane = road_map.lane(id);
    for (const LaneId from : road_map.graph().of(id).predecessors) {
      if (road_map.lane(from).junction == lane.junction) continue;
      PlannedIncoming& incoming = by_leader[leftmost(road_map, from)];
      if (std::find(incoming.lanes.begin(), incoming.lanes.end(), from) == incoming.lanes.end()) {
        incoming.lanes.push_back(from);
      }
      sort_by_turn(lane, incoming);
    }
  }
  if (by_leader.empty()) return intersection;
  intersection.id = ids.give(junction.source_id);
  for (auto& [leader, incoming] : by_leader) {
    incoming.id = ids.give({});
    intersection.incomings.push_back(std::move(incoming));
  }
  return intersection;
}

}  // namespace

std::vector<PlannedIntersection> plan_intersections(const RoadMap& road_map, IdGiver& ids) {
  std::vector<PlannedIntersection> planned;
  for (const Regulation& rule : road_map.regulations()) {
    if (rule.type == "intersection") planned.push_back(from_regulation(rule, ids));
  }
  if (planned.empty()) {
    std::vector<std::vector<LaneId>> inside(road_map.junctions().size());
    for (const Lane& lane : road_map.lanes()) {
      if (lane.junction && is_drivable(lane.type)) inside[lane.junction->index].push_back(lane.id);
    }
    for (const Junction& junction : road_map.junctions()) {
      planned.push_back(from_junction(road_map, junction, inside[junction.id.index], ids));
    }
  }
  std::erase_if(planned, [](const PlannedIntersection& i) { return i.incomings.empty(); });
  return planned;
}

}  // namespace roadbed::map::commonroad
