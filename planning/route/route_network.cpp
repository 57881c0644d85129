#include "roadbed/planning/route/route_network.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "roadbed/map/elements/lane_bend.h"

namespace roadbed::planning::inline route {
namespace {

using map::Lane;

constexpr double kUTurn_rad = 150.0 * std::numbers::pi / 180.0;

}  // namespace

Turn bend_of(const Lane& lane) {
  const double angle_rad = map::bend_rad(lane);
  if (std::abs(angle_rad) > kUTurn_rad) return Turn::u_turn;
  if (std::abs(angle_rad) < map::kTurnsOff_rad) return Turn::straight;
  return angle_rad > 0.0 ? Turn::left : Turn::right;
}

bool may_use(const Lane& lane, map::Participant kind) {
  if (!lane.participants.has(kind)) return false;
  if (!map::Participants::vehicles().has(kind)) return true;
  return is_drivable(lane.type) || lane.type == map::LaneType::bus ||
         lane.type == map::LaneType::taxi;
}

bool may_reverse(const Lane& lane, map::Participant kind) {
  // OpenDRIVE gives sidewalks a side of their road, no direction.
  const bool is_pavement = lane.road && lane.type == map::LaneType::sidewalk;
  return may_use(lane, kind) &&
         (!lane.one_way || (is_pavement && kind == map::Participant::pedestrian));
}

}  // namespace roadbed::planning::route
