#include "roadbed/planning/route/route_network.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "roadbed/geometry/primitives/angle.h"

namespace roadbed::planning::inline route {
namespace {

using map::Lane;

constexpr double kEndChord_m = 1.0;
constexpr double kTurn_rad = 30.0 * std::numbers::pi / 180.0;
constexpr double kUTurn_rad = 150.0 * std::numbers::pi / 180.0;

double heading_between(const geometry::Polyline& line, double from_m, double to_m) {
  const Eigen::Vector2d along = line.at(to_m) - line.at(from_m);
  return std::atan2(along.y(), along.x());
}

}  // namespace

Turn bend_of(const Lane& lane) {
  const auto& line = lane.centre.in_map;
  const double chord_m = std::min(kEndChord_m, 0.5 * line.length_m());
  const double angle_rad =
      geometry::wrap_angle(heading_between(line, line.length_m() - chord_m, line.length_m()) -
                           heading_between(line, 0.0, chord_m));
  if (std::abs(angle_rad) > kUTurn_rad) return Turn::u_turn;
  if (std::abs(angle_rad) < kTurn_rad) return Turn::straight;
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
