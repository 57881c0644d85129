#include "roadbed/planning/maneuvers/lane_passing.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "roadbed/map/derived/lane_relations.h"

namespace roadbed::planning::inline maneuvers {
namespace {

using map::LaneId;
using map::Neighbour;

constexpr double kLaneStep_m = 5.0;
constexpr double kLanesJoined_m = 5.0, kSameOffset_m = 0.6;  // of lanes that follow on one another
constexpr double kLeastGain_s = 4.0;
constexpr double kFaster_mps = 1.0;  // than who is passed, at least
constexpr double kPassedWithin_m = 120.0;
constexpr double kPassedBeside_m = 0.3,
                 kPassedBeside_s = 0.05;  // to both sides of who passes within the lane
constexpr double kLaneChange_s = 3.5;     // to change lanes in
constexpr double kOwnSpeedUp_mps2 = 0.9;  // less than what the cruise control was seen to do
constexpr double kPlatoon_m = 15.0, kPlatoon_s = 1.5;  // nearer cars are passed together
constexpr double kBeforeLaneEnd_m = 10.0;              // of the lane, to be back
constexpr double kKeptAhead_m = 5.0,
                 kKeptAhead_s = 1.0;  // kept from who is ahead in the lane to enter
constexpr double kKeptBehind_m = 4.0, kKeptBehind_s = 0.4;  // and from who is behind there
constexpr double kOthersBrake_mps2 = 2.0, kOwnBrake_mps2 = 1.5;
constexpr double kPullOut_m = 2.0, kPullOut_s = 2.0;  // to the lead, before leaving its lane
constexpr double kFallsBack_mps = 2.0;                // slower than who is beside
constexpr double kLeastWidth_m = 2.6;                 // of a lane to pass in
constexpr double kSoon_s = 8.0;                       // who is closed up to within that is no gain

/// What keeps the body out of a lane at this offset.
double keeps_out_of_m(const PassingLane& lane, const geometry::VehicleShape& vehicle) {
  return std::max(0.0, 0.5 * std::abs(lane.offset_m) - 0.5 * vehicle.width_m);
}

const PassingLane* lane_at(const std::vector<PassingLane>& lanes, double s_m) {
  const auto found = std::ranges::find_if(
      lanes, [&](const PassingLane& lane) { return s_m >= lane.from_s_m && s_m <= lane.to_s_m; });
  return found == lanes.end() ? nullptr : &*found;
}

double station_of(const map::Lane& lane, double lane_s_m, const ReferenceLine& line) {
  return line.project(lane.pose_at(lane_s_m).position()).s_m;
}

// The part of a lane that is wide enough, and its mean offset from the line.
void set_part(const map::Lane& lane, const ReferenceLine& line, PassingLane& part) {
  double sum = 0.0, from_s_m = part.to_s_m, to_s_m = part.from_s_m;
  int count = 0;
  for (double s_m = 0.0; s_m <= lane.length_m(); s_m += kLaneStep_m) {
    const geometry::LinePosition at = line.project(lane.pose_at(s_m).position());
    if (at.s_m < part.from_s_m - kLaneStep_m || at.s_m > part.to_s_m + kLaneStep_m) continue;
    if (lane.width_m(s_m) < kLeastWidth_m) {
      if (count > 0) break;
      continue;
    }
    from_s_m = std::min(from_s_m, at.s_m - kLaneStep_m);
    to_s_m = std::max(to_s_m, at.s_m + kLaneStep_m);
    sum += at.d_m;
    ++count;
  }
  part.from_s_m = std::max(part.from_s_m, from_s_m);
  part.to_s_m = std::min(part.to_s_m, to_s_m);
  part.offset_m = count > 0 ? sum / count : 0.0;
}

// Of a lane's stations those within a part of it, as stations of the line.
std::vector<map::StationRange> windows_along(const ReferenceLine& line, const map::Lane& lane,
                                             const std::vector<map::StationRange>& windows,
                                             const map::StationRange& part) {
  std::vector<map::StationRange> along;
  for (const map::StationRange& window : windows) {
    const double from_m = std::max(window.from_s_m, part.from_s_m);
    const double to_m = std::min(window.to_s_m, part.to_s_m);
    if (to_m > from_m)
      along.push_back({station_of(lane, from_m, line), station_of(lane, to_m, line)});
  }
  return along;
}

std::optional<PassingLane> beside(const map::RoadMap& road_map, const RouteLeg& leg, double side,
                                  const ReferenceLine& line) {
  const map::LaneLinks& links = road_map.graph().of(leg.lane);
  const std::optional<Neighbour>& next = side > 0.0 ? links.left : links.right;
  if (leg.reversed || !next || !next->same_direction) return std::nullopt;
  if (!map::is_drivable(road_map.lane(next->lane).type)) return std::nullopt;
  const map::Lane& own = road_map.lane(leg.lane);
  PassingLane lane{.from_s_m = station_of(own, leg.from_s_m, line),
                   .to_s_m = station_of(own, leg.to_s_m, line)};
  set_part(road_map.lane(next->lane), line, lane);
  if (lane.to_s_m <= lane.from_s_m) return std::nullopt;
  const map::StationRange of_leg{leg.from_s_m, leg.to_s_m};
  lane.change_windows = windows_along(line, own, next->change_windows, of_leg);
  const map::Lane& there = road_map.lane(next->lane);
  const map::LaneLinks& from_there = road_map.graph().of(next->lane);
  const std::optional<Neighbour>& back = side > 0.0 ? from_there.right : from_there.left;
  if (back && back->lane == leg.lane) {
    lane.return_windows = windows_along(line, there, back->change_windows, {0.0, there.length_m()});
  }
  return lane;
}

void append(const std::vector<map::StationRange>& windows, std::vector<map::StationRange>& all) {
  for (const map::StationRange& window : windows) {
    if (!all.empty() && window.from_s_m - all.back().to_s_m < kLanesJoined_m) {
      all.back().to_s_m = window.to_s_m;
    } else {
      all.push_back(window);
    }
  }
}

void join(PassingLane next, std::vector<PassingLane>& lanes) {
  if (lanes.empty() || next.from_s_m - lanes.back().to_s_m > kLanesJoined_m ||
      std::abs(next.offset_m - lanes.back().offset_m) > kSameOffset_m) {
    lanes.push_back(std::move(next));
    return;
  }
  PassingLane& last = lanes.back();
  last.to_s_m = std::max(last.to_s_m, next.to_s_m);
  append(next.change_windows, last.change_windows);
  append(next.return_windows, last.return_windows);
}

/// On which one passes: 1 left, −1 right, where one drives on the left.
double side_to_pass_on(const map::RoadMap& road_map) {
  return map::drives_on_the_left(road_map) ? -1.0 : 1.0;
}

std::string why_on_neither_side(const std::string& id, double side) {
  const bool is_left = side > 0.0;
  return fmt::format("{} is not passed: there is no lane to its {}, and nobody is passed on the {}",
                     id, is_left ? "left" : "right", is_left ? "right" : "left");
}

}  // namespace

std::vector<PassingLane> passing_lanes(const map::RoadMap& road_map, const Route& route,
                                       const ReferenceLine& line) {
  return lanes_beside(road_map, route, line, side_to_pass_on(road_map));
}

std::vector<PassingLane> lanes_beside(const map::RoadMap& road_map, const Route& route,
                                      const ReferenceLine& line, double side) {
  std::vector<PassingLane> lanes;
  for (const RouteLeg& leg : route.legs) {
    if (auto lane = beside(road_map, leg, side, line)) join(*std::move(lane), lanes);
  }
  return lanes;
}

/// What is looked at in one cycle.
struct LanePassing::Scene {
  const ViewOnLine& view;
  const PassingLane& lane;
  std::vector<MoverOnLine> movers;
  double free_mps;  ///< at which the vehicle would drive on an empty road
};

LanePassing::LanePassing(const geometry::VehicleShape& vehicle, const DrivingTask& task,
                         const SpeedCeiling& ceiling)
    : vehicle_(vehicle),
      task_(task),
      ceiling_(ceiling),
      side_(side_to_pass_on(task.road_map)),
      lanes_(lanes_beside(task.road_map, task.route, task.line, side_)),
      lanes_on_wrong_side_(lanes_beside(task.road_map, task.route, task.line, -side_)) {}

/// Whether who stands leaves too little of the route's lane to pass within it at speed.
bool LanePassing::closes_lane(const Scene& scene, const MoverOnLine& standing) const {
  const double half_m = 0.5 * std::abs(scene.lane.offset_m);
  const double room_m = half_m + std::abs(standing.d_m) - standing.half_width_m;
  const double beside_m = std::max(kPassedBeside_m, kPassedBeside_s * scene.free_mps);
  return room_m < vehicle_.width_m + 2.0 * beside_m;
}

/// The nearest one that drives ahead in the route's lane, or stands there and closes it.
const MoverOnLine* LanePassing::lead_of(const Scene& scene) const {
  const MoverOnLine* nearest = nullptr;
  for (const MoverOnLine& mover : scene.movers) {
    if (!mover.shares_way(0.0, vehicle_) || mover.s_m < scene.view.at.s_m) continue;
    if (mover.stands && !closes_lane(scene, mover)) continue;
    if (gap_m(scene, mover) > std::max(kPassedWithin_m, soon_m(scene, mover))) continue;
    if (!nearest || mover.s_m < nearest->s_m) nearest = &mover;
  }
  return nearest;
}

/// Bumper to bumper.
double LanePassing::gap_m(const Scene& scene, const MoverOnLine& lead) const {
  return lead.rear_m() - scene.view.at.s_m - vehicle_.front_m();
}

/// Until the goal, at the speeds of now.
double LanePassing::gained_s(const Scene& scene, const MoverOnLine& lead) const {
  const double lead_mps = std::max(1.0, lead.speed_mps);
  if (scene.free_mps < lead_mps + kFaster_mps) return 0.0;
  const double left_m = task_.line.goal_s_m() - scene.view.at.s_m;
  return (left_m - gap_m(scene, lead)) / lead_mps - left_m / scene.free_mps;
}

/// Room ahead to pass all who drive closely together, and to come back; who is as slow as in a
/// queue has all of it to pass that is seen, as its gaps close.
std::optional<std::string> LanePassing::why_no_room(const Scene& scene,
                                                    const MoverOnLine& lead) const {
  double last_m = lead.front_m();
  const bool queues = lead.speed_mps < kQueue_mps;
  for (bool grows = true; grows;) {
    grows = false;
    for (const MoverOnLine& mover : scene.movers) {
      const double near_m = last_m + kPlatoon_m + kPlatoon_s * lead.speed_mps;
      if (!mover.shares_way(0.0, vehicle_) || mover.front_m() <= last_m) continue;
      if (mover.rear_m() > near_m && !(queues && mover.speed_mps < kQueue_mps)) continue;
      last_m = mover.front_m();
      grows = true;
    }
  }
  const double lead_mps = std::max(0.0, lead.speed_mps);
  const double past_m = last_m + kKeptBehind_m + kKeptBehind_s * scene.free_mps +
                        vehicle_.rear_overhang_m - scene.view.at.s_m;
  const double speeding_up_s =
      std::max(0.0, scene.free_mps - scene.view.speed_mps) / kOwnSpeedUp_mps2;
  const double slow_by_m = 0.5 * speeding_up_s * (scene.free_mps - scene.view.speed_mps);
  const double passes_s =
      (past_m + slow_by_m) / std::max(kFaster_mps, scene.free_mps - lead_mps) + kLaneChange_s;
  const double needed_m = scene.free_mps * passes_s - slow_by_m + kBeforeLaneEnd_m;
  const double end_m = std::min(scene.lane.to_s_m, task_.line.goal_s_m());
  const double missing_m = needed_m - (end_m - scene.view.at.s_m);
  if (missing_m <= 0.0) return std::nullopt;
  return fmt::format("there are {:.0f} m too few to come back", missing_m);
}

/// Whether a lane can be changed to: nobody beside, who is ahead is not closed up to, who is behind
/// need not brake hard.
/// @param gain_over_mps  who is no faster ahead there is in the way, too; none: that is no matter.
std::optional<std::string> LanePassing::why_no_gap(const Scene& scene, double d_m,
                                                   std::optional<double> gain_over_mps) const {
  const double rear_m = scene.view.at.s_m - vehicle_.rear_overhang_m;
  const double speed_mps = scene.view.speed_mps;
  const double entered_mps =
      std::min(std::max(speed_mps, scene.free_mps), speed_mps + kOwnSpeedUp_mps2 * kLaneChange_s);
  for (const MoverOnLine& mover : scene.movers) {
    if (!mover.shares_way(d_m, vehicle_)) continue;
    const std::string& id = task_.obstacles[mover.obstacle].id;
    if (mover.s_m >= scene.view.at.s_m) {
      const double closing_mps = std::max(0.0, speed_mps - mover.speed_mps);
      const double needed_m = kKeptAhead_m + kKeptAhead_s * std::max(0.0, mover.speed_mps) +
                              0.5 * closing_mps * closing_mps / kOwnBrake_mps2;
      const double ahead_m = gap_m(scene, mover);
      if (ahead_m < needed_m) {
        return fmt::format("{} is {:.0f} m too near in the next lane", id, needed_m - ahead_m);
      }
      const double soon_m = std::max(0.0, scene.free_mps - mover.speed_mps) * kSoon_s;
      if (gain_over_mps && mover.speed_mps < *gain_over_mps + kFaster_mps &&
          ahead_m < needed_m + soon_m) {
        return fmt::format("{} is no faster in the next lane", id);
      }
    } else {
      const double closing_mps = std::max(0.0, mover.speed_mps - entered_mps);
      const double closed_m =
          std::max(0.0, mover.speed_mps - 0.5 * (speed_mps + entered_mps)) * kLaneChange_s;
      const double needed_m = kKeptBehind_m + kKeptBehind_s * std::max(0.0, mover.speed_mps) +
                              closed_m + 0.5 * closing_mps * closing_mps / kOthersBrake_mps2;
      const double behind_m = rear_m - mover.front_m();
      if (behind_m < needed_m) {
        return fmt::format("{} comes up behind in the next lane, the gap is {:.0f} m too short", id,
                           needed_m - behind_m);
      }
    }
  }
  return std::nullopt;
}

std::optional<std::string> LanePassing::why_not(const Scene& scene, const MoverOnLine& lead) const {
  if (!may_cross(scene, scene.lane.change_windows)) return "the marking may not be crossed here";
  const auto comes_back = [&](const map::StationRange& window) {
    return window.to_s_m > lead.s_m + kLaneChange_s * scene.free_mps;
  };
  if (std::ranges::none_of(scene.lane.return_windows, comes_back)) {
    return "the marking may not be crossed to come back";
  }
  const double closing_mps = std::max(0.0, scene.view.speed_mps - lead.speed_mps);
  if (gap_m(scene, lead) < kPullOut_m + kPullOut_s * closing_mps)
    return "it is too near to pull out";
  if (auto why = why_no_room(scene, lead)) return why;
  return why_no_gap(scene, scene.lane.offset_m, lead.speed_mps);
}

/// The marking may be crossed here, and as long as a change takes that speeds up.
bool LanePassing::may_cross(const Scene& scene,
                            const std::vector<map::StationRange>& windows) const {
  const double way_m =
      geometry::speeding_up_m(scene.view.speed_mps, kOwnSpeedUp_mps2,
                              std::max(scene.view.speed_mps, scene.free_mps), kLaneChange_s);
  return std::ranges::any_of(windows, [&](const map::StationRange& window) {
    return scene.view.at.s_m >= window.from_s_m && scene.view.at.s_m + way_m <= window.to_s_m;
  });
}

/// A lead nearer than that is caught up with soon.
double LanePassing::soon_m(const Scene& scene, const MoverOnLine& lead) const {
  return kKeptAhead_m + kKeptAhead_s * lead.speed_mps +
         kSoon_s * std::max(0.0, scene.free_mps - lead.speed_mps);
}

/// The speed that lets a gap open behind who is beside, where passing is no use any more; none: it
/// goes on.
std::optional<double> LanePassing::falls_back_mps(const Scene& scene) const {
  const MoverOnLine* nearest = nullptr;  // in the route's lane
  const auto away_m = [&](const MoverOnLine& mover) {
    return std::abs(mover.s_m - scene.view.at.s_m);
  };
  for (const MoverOnLine& mover : scene.movers) {
    if (mover.stands || !mover.shares_way(0.0, vehicle_)) continue;
    if (!nearest || away_m(mover) < away_m(*nearest)) nearest = &mover;
  }
  if (nearest == nullptr) return std::nullopt;
  const bool is_no_faster = scene.free_mps < nearest->speed_mps + 0.5 * kFaster_mps;
  const bool is_past = nearest->front_m() < scene.view.at.s_m - vehicle_.rear_overhang_m;
  if (!is_no_faster && (is_past || !why_no_room(scene, *nearest))) return std::nullopt;
  return std::max(0.0, nearest->speed_mps - kFallsBack_mps);
}

/// There is a gap in the route's lane, and nobody there to pass again soon.
bool LanePassing::may_return(const Scene& scene) const {
  const MoverOnLine* lead = lead_of(scene);
  if (lead != nullptr) {
    const bool soon = gap_m(scene, *lead) < soon_m(scene, *lead);
    if (soon && gained_s(scene, *lead) >= kLeastGain_s && !why_no_room(scene, *lead)) return false;
  }
  const bool is_last_chance =
      std::ranges::none_of(scene.lane.return_windows, [&](const map::StationRange& window) {
        return window.to_s_m > scene.view.at.s_m + kLaneChange_s * scene.view.speed_mps;
      });
  return (may_cross(scene, scene.lane.return_windows) || is_last_chance) && !why_no_gap(scene, 0.0);
}

bool LanePassing::has_left_lane(const Scene& scene) const {
  return std::abs(scene.view.at.d_m) > 0.4 * std::abs(scene.lane.offset_m);
}

LanePassing::Decision LanePassing::look(const ViewOnLine& view) {
  const PassingLane* lane = lane_at(lanes_, view.at.s_m);
  const PassingLane* on_wrong_side = lane_at(lanes_on_wrong_side_, view.at.s_m);
  if (lane == nullptr) passed_.reset();
  if (lane == nullptr && on_wrong_side == nullptr) return {};
  const Scene scene{view, lane != nullptr ? *lane : *on_wrong_side,
                    movers_on_line(task_.line, view.traffic, view.t_s, true),
                    ceiling_.at(view.at.s_m).speed_mps};
  const MoverOnLine* lead = lead_of(scene);
  Decision decision{.side = side_};
  if (lead != nullptr && !lead->stands) {
    if (lane != nullptr) decision.keep_within_m = keeps_out_of_m(*lane, vehicle_);
    if (on_wrong_side != nullptr) {
      decision.keep_within_on_wrong_side_m = keeps_out_of_m(*on_wrong_side, vehicle_);
    }
  }
  if (!passed_) {
    if (lead == nullptr || gained_s(scene, *lead) < kLeastGain_s) return decision;
    if (gap_m(scene, *lead) > soon_m(scene, *lead)) return decision;
    const std::string& id = task_.obstacles[lead->obstacle].id;
    if (lane == nullptr) {
      if (!lead->stands) decision.reason = why_on_neither_side(id, side_);
      return decision;
    }
    if (const auto why = why_not(scene, *lead)) {
      decision.reason = fmt::format("{} is not passed: {}", id, *why);
      return decision;
    }
    passed_ = lead->obstacle;
  } else if (has_left_lane(scene) ? may_return(scene)
                                  : why_no_gap(scene, lane->offset_m).has_value()) {
    passed_.reset();
    return decision;
  }
  decision.offset_m = lane->offset_m;
  decision.passed = passed_;
  decision.lane_end_s_m = lane->to_s_m;
  if (has_left_lane(scene)) decision.most_mps = falls_back_mps(scene);
  decision.reason = fmt::format("{} {}", decision.most_mps ? "falls back behind" : "passes",
                                task_.obstacles[*passed_].id);
  return decision;
}

}  // namespace roadbed::planning::maneuvers
