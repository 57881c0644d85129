#include "roadbed/planning/behaviour/merging.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "roadbed/geometry/primitives/angle.h"
#include "roadbed/planning/behaviour/lead.h"
#include "roadbed/planning/behaviour/speed_controller.h"

namespace roadbed::planning::inline behaviour {
namespace {

using map::LaneId;

constexpr double kLaneBack_m = 250.0, kLaneOn_m = 100.0;  // along the next lane
constexpr double kMergeFrom_m = 150.0;                    // before the place gaps are looked at
constexpr double kInTheWay_m = 2.0;  // from the next lane's middle, side to side with its traffic
constexpr double kOutOfWay_m = 2.6;  // and nobody's concern
constexpr double kInNextLane_m = 0.5;
constexpr double kPlaceStep_m = 0.5, kMostChange_m = 80.0;
constexpr double kBeyondHold_m = 0.3;  // the vehicle is on its way
constexpr double kWaits_mps2 = 1.5;
constexpr double kDrivesThere_m = 1.6;  // from the middle of the lane

double turn_over(const map::Lane& lane) {
  const double from = lane.pose_at(0.0).heading_rad;
  return std::abs(geometry::wrap_angle(lane.pose_at(lane.length_m()).heading_rad - from));
}

std::optional<LaneId> straightest(const map::RoadMap& road_map, const std::vector<LaneId>& lanes) {
  std::optional<LaneId> best;
  for (const LaneId id : lanes) {
    if (!map::is_drivable(road_map.lane(id).type)) continue;
    if (!best || turn_over(road_map.lane(id)) < turn_over(road_map.lane(*best))) best = id;
  }
  return best;
}

/// The lane of a leg, what leads to it, and what the route goes on with.
geometry::Polyline lane_merged_into(const map::RoadMap& road_map, const Route& route,
                                    std::size_t leg) {
  std::vector<LaneId> lanes{route.legs[leg].lane};
  double back_m = route.legs[leg].from_s_m;
  while (back_m < kLaneBack_m && lanes.size() < 50) {
    const auto before = straightest(road_map, road_map.graph().of(lanes.front()).predecessors);
    if (!before) break;
    lanes.insert(lanes.begin(), *before);
    back_m += road_map.lane(*before).length_m();
  }
  double on_m = road_map.lane(route.legs[leg].lane).length_m() - route.legs[leg].from_s_m;
  for (std::size_t i = leg; i + 1 < route.legs.size() && on_m < kLaneOn_m; ++i) {
    if (route.legs[i].exit != LegExit::successor) break;
    lanes.push_back(route.legs[i + 1].lane);
    on_m += road_map.lane(lanes.back()).length_m();
  }
  std::vector<Eigen::Vector2d> points;
  for (const LaneId id : lanes) {
    for (const Eigen::Vector2d& point : road_map.lane(id).centre.in_map.points()) {
      constexpr double kJoint_m = 0.05;
      if (points.empty() || (point - points.back()).norm() > kJoint_m) points.push_back(point);
    }
  }
  return geometry::Polyline(std::move(points));
}

bool changes_lane(const RouteLeg& leg) {
  return leg.exit == LegExit::change_left || leg.exit == LegExit::change_right;
}

std::optional<MergePlace> place_behind(const map::RoadMap& road_map, const Route& route,
                                       std::size_t leg, const ReferenceLine& line) {
  const RouteLeg& left = route.legs[leg];
  if (left.reversed || leg + 1 >= route.legs.size()) return std::nullopt;
  MergePlace place{.lane = lane_merged_into(road_map, route, leg + 1)};
  const double middle_s_m =
      line.project(road_map.lane(left.lane).pose_at(left.to_s_m).position()).s_m;
  const auto beside_m = [&](double s_m) {
    return std::abs(place.lane.project(line.at(s_m).in_map).d_m);
  };
  const auto first_m = [&](double step_m, const auto& is_there) {
    double s_m = middle_s_m;
    while (std::abs(s_m - middle_s_m) < kMostChange_m && !is_there(beside_m(s_m))) s_m += step_m;
    return s_m;
  };
  place.hold_s_m = first_m(-kPlaceStep_m, [](double d_m) { return d_m >= kOutOfWay_m; });
  place.enter_s_m = first_m(-kPlaceStep_m, [](double d_m) { return d_m >= kInTheWay_m; });
  place.out_s_m = first_m(kPlaceStep_m, [](double d_m) { return d_m <= kInNextLane_m; });
  place.enter_m = place.lane.project(line.at(place.enter_s_m).in_map).s_m;
  return place;
}

}  // namespace

std::vector<MergePlace> merge_places(const map::RoadMap& road_map, const Route& route,
                                     const ReferenceLine& line) {
  std::vector<MergePlace> places;
  for (std::size_t i = 0; i < route.legs.size(); ++i) {
    if (!changes_lane(route.legs[i])) continue;
    if (auto place = place_behind(road_map, route, i, line)) places.push_back(*std::move(place));
  }
  return places;
}

Merging::Merging(const geometry::VehicleShape& vehicle, const DrivingTask& task,
                 const SpeedCeiling& ceiling)
    : vehicle_(vehicle),
      task_(task),
      ceiling_(ceiling),
      places_(merge_places(task.road_map, task.route, task.line)) {}

const MergePlace* Merging::next_place(double s_m) {
  while (next_ < places_.size() && s_m > places_[next_].out_s_m) {
    ++next_;
    has_entered_ = false;
    taken_.reset();
  }
  if (next_ == places_.size()) return nullptr;
  const MergePlace& place = places_[next_];
  return place.enter_s_m - s_m < kMergeFrom_m ? &place : nullptr;
}

std::vector<MergeMover> Merging::movers(const MergePlace& place, const ViewOnLine& view) const {
  std::vector<MergeMover> movers;
  for (std::size_t i = 0; i < view.traffic.obstacles.size(); ++i) {
    const Obstacle& obstacle = view.traffic.obstacles[i];
    if (!obstacle.is_there(view.t_s)) continue;
    const geometry::TrajectoryPoint now = obstacle.motion.at(view.t_s);
    const geometry::LinePosition at = place.lane.project(now.pose().position());
    if (std::abs(at.d_m) > kDrivesThere_m) continue;
    const double turned = now.heading_rad - place.lane.pose_at(at.s_m).heading_rad;
    movers.push_back({.obstacle = i,
                      .to_enter_m = place.enter_m - at.s_m,
                      .half_length_m = 0.5 * obstacle.length_m,
                      .speed_mps = obstacle.is_static() ? 0.0 : now.speed_mps * std::cos(turned)});
  }
  std::ranges::sort(movers, {}, &MergeMover::to_enter_m);
  return movers;
}

/// Who comes from behind in the next lane keeps its distance, once the vehicle is there.
Merging::Decision Merging::entering(const MergePlace& place, const std::vector<MergeMover>& movers,
                                    const ViewOnLine& view) const {
  const double rear_to_enter_m = place.enter_s_m - view.at.s_m + vehicle_.rear_overhang_m;
  Decision decision{.comes_behind = std::vector<bool>(view.traffic.obstacles.size(), false),
                    .merged_behind = merged_behind_};
  for (const MergeMover& mover : movers) {
    const bool is_behind = mover.to_enter_m - mover.half_length_m > rear_to_enter_m;
    decision.comes_behind[mover.obstacle] = is_behind;
  }
  return decision;
}

/// Drives up to a gap, in front of those who will follow.
Merging::Decision Merging::approaching(const MergeGap& gap, const std::vector<MergeMover>& movers,
                                       const ViewOnLine& view) const {
  Decision decision{.comes_behind = std::vector<bool>(view.traffic.obstacles.size(), false)};
  bool is_behind = false;
  for (const MergeMover& mover : movers) {
    is_behind = is_behind || gap.behind == mover.obstacle;
    decision.comes_behind[mover.obstacle] = is_behind;
  }
  decision.most_mps = gap.speed_mps;
  decision.merged_behind = gap.ahead;
  decision.reason = gap.ahead ? fmt::format("merges behind {}", name_of(*gap.ahead))
                              : fmt::format("merges before {}", name_of(*gap.behind));
  return decision;
}

/// A vehicle that is too fast for the place brakes harder, up to where it is in the way.
Merging::Decision Merging::waiting(const MergePlace& place, const MergeGap& gap,
                                   const ViewOnLine& view) const {
  std::string who =
      gap.lacks_ahead ? "behind " + name_of(*gap.ahead) : "before " + name_of(*gap.behind);
  if (gap.lacks_ahead && gap.lacks_behind) who += " and before " + name_of(*gap.behind);
  StopConstraint halt{.s_m = place.hold_s_m - vehicle_.front_m(),
                      .reason = fmt::format("no gap to merge into: {:.0f} m are missing {}",
                                            std::ceil(gap.missing_m), who)};
  const double way_m = halt.s_m - view.at.s_m - view.speed_mps * kActuatorLag_s;
  const double needed_mps2 = 0.5 * view.speed_mps * view.speed_mps / std::max(0.5, way_m);
  halt.deceleration_mps2 = std::clamp(needed_mps2, kWaits_mps2, SafetyOptions{}.most_mps2);
  halt.is_hard = halt.deceleration_mps2 > kMostCommand_mps2;
  return {.halt = std::move(halt)};
}

/// Drives in the next lane already.
bool Merging::is_in(const MergePlace& place, const ViewOnLine& view) const {
  const ReferencePoint foot = task_.line.at(view.at.s_m);
  const Eigen::Vector2d left(-std::sin(foot.heading_rad), std::cos(foot.heading_rad));
  return std::abs(place.lane.project(foot.in_map + view.at.d_m * left).d_m) < kInNextLane_m;
}

std::string Merging::name_of(std::size_t obstacle) const {
  return fmt::format("{} {}", task_.obstacles[obstacle].kind, task_.obstacles[obstacle].id);
}

Merging::Decision Merging::look(const ViewOnLine& view) {
  const MergePlace* place = next_place(view.at.s_m);
  if (place == nullptr) return {.merged_behind = merged_behind_};
  if (is_in(*place, view)) return {.merged_behind = merged_behind_};
  const double front_s_m = view.at.s_m + vehicle_.front_m();
  const std::vector<MergeMover> around = movers(*place, view);
  const bool is_past_hold = front_s_m > place->hold_s_m + kBeyondHold_m;
  has_entered_ = has_entered_ || front_s_m > place->enter_s_m || (is_past_hold && taken_);
  if (around.empty()) return {};
  if (has_entered_) return entering(*place, around, view);
  const double free_mps = std::max(1.0, ceiling_.at(place->enter_s_m).speed_mps);
  const MergeGap gap = choose_merge_gap({.to_enter_m = place->enter_s_m - front_s_m,
                                         .length_m = vehicle_.length_m,
                                         .speed_mps = view.speed_mps,
                                         .free_mps = free_mps},
                                        around, taken_);
  taken_.reset();
  merged_behind_.reset();
  if (!gap.is_good) return waiting(*place, gap, view);
  taken_ = gap;
  merged_behind_ = gap.ahead;
  return approaching(gap, around, view);
}

}  // namespace roadbed::planning::behaviour
