#include "roadbed/planning/right_of_way/right_of_way.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "roadbed/planning/obstacles/foreseen_motion.h"
#include "roadbed/planning/speed/lead.h"
#include "roadbed/planning/speed/path_profile.h"
#include "roadbed/planning/speed/speed_controller.h"
#include "roadbed/planning/speed/st_graph.h"

namespace roadbed::planning::inline right_of_way {
namespace {

constexpr double kBeforeLine_m = 0.5;  // kept from a line
constexpr double kPassed_m = 0.3;      // beyond it the vehicle is on its way
constexpr double kLookAhead_m = 80.0;  // at least, else what a comfortable stop takes
constexpr double kSameHalt_m = 0.5;
constexpr double kFractionOfBrakes = 0.9;  // the rest is left to the cruise control
constexpr double kStopsShort_m = 0.1;      // of a line, at the latest
constexpr double kRedSlack_s = 0.2;        // before red, to be past the line
constexpr double kAtRest_mps = 0.1, kAtLine_m = 1.5;
constexpr double kJoining_m = 40.0;  // beyond a junction, to be as fast as others
constexpr double kCrossingMargin_m = 0.4;
constexpr double kMovingOther_mps = 0.5;
constexpr double kLeastAlong = 0.8;    // cosine of the angle up to which somebody drives along
constexpr double kBesideLane_m = 0.5;  // more, from who comes along it
constexpr double kLooks_s = 3.0;       // where more is seen, before driving on
constexpr double kGapsFrom_m = 15.0;   // beyond the way to stop on

/// How obstacles that are no lead drive now; one entry per obstacle.
struct Others {
  std::vector<bool> crossing;   ///< on the path, but across it
  std::vector<bool> following;  ///< behind the vehicle in its lane: they keep their distance
};

/// Obstacles that are on the path now, but cross it.
std::vector<bool> crossing_now(const PathProfile& profile, const StGraph& occupancy,
                               const RightOfWay::View& view) {
  std::vector<bool> crossing(view.traffic.obstacles.size(), false);
  for (const StInterval& part : occupancy.at(0)) {
    const Obstacle& obstacle = view.traffic.obstacles[part.obstacle];
    if (obstacle.is_static()) continue;
    const geometry::TrajectoryPoint at = obstacle.motion.at(view.t_s);
    const Eigen::Vector2d along(std::cos(at.heading_rad), std::sin(at.heading_rad));
    const Eigen::Vector2d& profile_along =
        profile.body[profile.before(std::max(0.0, part.from_m))].axis;
    crossing[part.obstacle] =
        at.speed_mps > kMovingOther_mps && along.dot(profile_along) < kLeastAlong;
  }
  return crossing;
}

/// Who is on the path already, and drives along it.
bool is_lead(const StGraph& occupancy, const Others& others, std::size_t obstacle) {
  return !others.crossing[obstacle] &&
         std::ranges::any_of(occupancy.at(0),
                             [&](const StInterval& part) { return part.obstacle == obstacle; });
}

/// Whether an obstacle that is not the lead blocks a place at one of the steps `from` to `to`.
std::optional<std::size_t> who_blocks(const StGraph& occupancy, const Others& others, int from,
                                      int to, double ahead_m) {
  for (int k = std::max(0, from); k <= to; ++k) {
    for (const StInterval& part : occupancy.at(k)) {
      const bool is_behind = part.from_m < 0.0 || others.following[part.obstacle];
      if (is_behind || ahead_m <= part.from_m || ahead_m >= part.to_m) continue;
      if (!is_lead(occupancy, others, part.obstacle)) return part.obstacle;
    }
  }
  return std::nullopt;
}

struct Met {
  std::size_t obstacle;
  double after_s;
};

/// Who is first met on the way, or nearly.
std::optional<Met> first_met(const StGraph& occupancy, const Others& others,
                             const std::vector<double>& ahead_m, RightOfWay::Gap gap) {
  for (std::size_t i = 0; i < ahead_m.size(); ++i) {
    const int k = static_cast<int>(i);
    const auto who = who_blocks(occupancy, others, k - gap.before, k + gap.after, ahead_m[i]);
    if (who) return Met{*who, StGraph::kStep_s * k};
  }
  return std::nullopt;
}

/// Who would be met if those who speed up kept doing so.
std::optional<Met> who_speeds_on(const PathProfile& profile, const std::vector<double>& ahead_m,
                                 const StGraph& occupancy, const Others& others,
                                 const RightOfWay::View& view, RightOfWay::Gap gap) {
  std::vector<Obstacle> faster;
  std::vector<std::size_t> whose;
  for (std::size_t i = 0; i < view.traffic.obstacles.size(); ++i) {
    const Obstacle& obstacle = view.traffic.obstacles[i];
    if (!obstacle.is_there(view.t_s) || others.following[i]) continue;
    auto motion = speeding_on(obstacle.motion, view.t_s);
    if (!motion || is_lead(occupancy, others, i)) continue;
    faster.push_back(obstacle);
    faster.back().motion = *std::move(motion);
    whose.push_back(i);
  }
  if (faster.empty()) return std::nullopt;
  const StGraph sooner(profile, Traffic{faster}, view.t_s,
                       static_cast<int>(ahead_m.size()) + gap.after, kCrossingMargin_m);
  const std::vector<bool> all(faster.size(), true), none(faster.size(), false);
  auto met = first_met(sooner, {all, none}, ahead_m, gap);
  if (met) met->obstacle = whose[met->obstacle];
  return met;
}

}  // namespace

RightOfWay::RightOfWay(const geometry::VehicleShape& vehicle, const DrivingOptions& options,
                       const DrivingTask& task)
    : vehicle_(vehicle),
      comfort_acceleration_mps2_(options.comfort_acceleration_mps2),
      comfort_deceleration_mps2_(options.comfort_deceleration_mps2),
      task_(task),
      hidden_(task) {}

double RightOfWay::left_m(const StopPoint& place, const View& view) const {
  return halt_m(place) - view.s_m - vehicle_.front_m();
}

/// Station of the front bumper, waiting.
double RightOfWay::halt_m(const StopPoint& place) const {
  return is_next(place) && creeps_to_m_ ? *creeps_to_m_ : place.s_m;
}

/// Having begun to cross, the vehicle goes on looking at those who may cross its path. Places are
/// found anew where a light comes into sight.
void RightOfWay::pass_places(const View& view) {
  const std::vector<StopPoint>& places = task_.stop_points;
  const auto go_to = [&](std::size_t next) {
    next_ = next;
    has_stopped_ = false;
    creeps_to_m_.reset();
    looks_since_s_.reset();
  };
  if (places.size() != std::exchange(places_, places.size())) {
    go_to(0);
    hidden_.forget();
  }
  while (next_ < places.size() && left_m(places[next_], view) < -kPassed_m) go_to(next_ + 1);
  if (next_ == 0) return;
  const StopPoint& last = places[next_ - 1];
  const bool is_crossing = view.s_m - vehicle_.rear_overhang_m < last.clear_s_m;
  if (last.kind == StopKind::light || !is_crossing) return;
  who_comes(last, view, kGapOnTheWay);
  if (!view.sight) return;
  creeps_ = who_hidden_is_met(next_ - 1, view).has_value();
}

double RightOfWay::look_ahead_m(double speed_mps) const {
  const double brakes_m = 0.5 * speed_mps * speed_mps / comfort_deceleration_mps2_;
  return std::max(kLookAhead_m, speed_mps * kActuatorLag_s + brakes_m + kBeforeLine_m);
}

/// The deceleration to stop with before a place; none: it is too late for that. The actuator's lag
/// lets the vehicle drive on for a while at the speed that its acceleration still leads to.
std::optional<double> RightOfWay::stops_with_mps2(const StopPoint& place, const View& view) const {
  if (kept_ && std::abs(kept_->s_m - place.s_m) < kSameHalt_m) return kept_->deceleration_mps2;
  const double hardest = kFractionOfBrakes * kMostCommand_mps2;
  const double comfortable = comfort_deceleration_mps2_;
  const double speed = std::max(0.0, view.speed_mps + view.acceleration_mps2 * kActuatorLag_s);
  const double left = left_m(place, view) - view.speed_mps * kActuatorLag_s;
  const double way_m = 0.5 * speed * speed / hardest;  // to stop in
  if (speed > kAtRest_mps && way_m > left - kStopsShort_m) {
    return stops_before_red_mps2(place, view);
  }
  if (way_m >= left - kBeforeLine_m) return hardest;
  return std::max(comfortable, 0.5 * speed * speed / (left - kBeforeLine_m));
}

/// Between the last place to stop at comfortably and the first from which a light is passed while
/// it is yellow there may be some metres: v² / 2a + v T against v · yellow.
std::optional<double> RightOfWay::stops_before_red_mps2(const StopPoint& place,
                                                        const View& view) const {
  if (place.kind != StopKind::light) return std::nullopt;
  const LightCycle& light = task_.lights[*place.light];
  if (colour_at(light, view.t_s) == LightColour::green) return std::nullopt;
  const double left = left_m(place, view);
  const double passes_in_s = left / std::max(kAtRest_mps, view.speed_mps) + kRedSlack_s;
  double red_in_s = 0.0;
  while (red_in_s <= passes_in_s && colour_at(light, view.t_s + red_in_s) != LightColour::red) {
    red_in_s += StGraph::kStep_s;
  }
  if (red_in_s > passes_in_s) return std::nullopt;
  const double free_m = left - kStopsShort_m - view.speed_mps * kActuatorLag_s;
  const double hard = 0.5 * view.speed_mps * view.speed_mps / std::max(0.1, free_m);
  if (hard > SafetyOptions{}.most_mps2) return std::nullopt;
  return hard;
}

std::optional<StopConstraint> RightOfWay::look(const View& view) {
  const std::vector<StopPoint>& places = task_.stop_points;
  crossing_.assign(view.traffic.obstacles.size(), false);
  creeps_ = false;
  pass_places(view);
  for (std::size_t i = next_; i < places.size(); ++i) {
    if (left_m(places[i], view) > look_ahead_m(view.speed_mps)) break;
    const std::optional<double> deceleration = stops_with_mps2(places[i], view);
    if (!deceleration) {
      if (places[i].kind != StopKind::light) who_comes(places[i], view, kGapOnTheWay);
      continue;
    }
    if (auto why = why_wait(places[i], view)) {
      kept_ = {places[i].s_m, *deceleration};
      return StopConstraint{halt_m(places[i]) - vehicle_.front_m() - kBeforeLine_m, *std::move(why),
                            *deceleration, *deceleration > kFractionOfBrakes * kMostCommand_mps2};
    }
  }
  kept_.reset();
  return std::nullopt;
}

std::optional<std::string> RightOfWay::why_wait(const StopPoint& place, const View& view) {
  const double left = left_m(place, view);
  if (place.kind == StopKind::light) {
    const LightColour colour = colour_at(task_.lights[*place.light], view.t_s);
    if (colour == LightColour::green) return std::nullopt;
    return fmt::format("{} is {}, {:.1f} m ahead", place.name, to_string(colour), left);
  }
  if (place.kind == StopKind::stop_sign && is_next(place)) {
    has_stopped_ = has_stopped_ || (view.speed_mps < kAtRest_mps && left < kAtLine_m);
    if (!has_stopped_) return fmt::format("{} is {:.1f} m ahead", place.name, left);
  }
  const double stopping_m = 0.5 * view.speed_mps * view.speed_mps / comfort_deceleration_mps2_;
  if (left > stopping_m + kGapsFrom_m) return std::nullopt;
  if (auto who = who_comes(place, view, kGapToTake)) return who;
  return who_may_come(place, view);
}

/// The way across, and when the vehicle is where on it.
struct RightOfWay::Crossing {
  PathProfile profile;
  std::vector<double> ahead_m;  ///< per step, speeding up slowly
  std::vector<double> most_m;   ///< as the style allows
  int steps_of_others;
};

RightOfWay::Crossing RightOfWay::crossing_of(const StopPoint& place, const View& view,
                                             Gap gap) const {
  // Joining crossing traffic, the vehicle is not to be caught up with soon.
  const bool joins = place.kind != StopKind::turn && gap.after == kGapToTake.after;
  const double until_m = place.clear_s_m + vehicle_.rear_overhang_m - view.s_m +
                         (joins ? kJoining_m : 0.0);  // of the rear axle
  Crossing crossing{sample_path_profile(view.path, view.path_s_m, std::max(1.0, until_m) + 2.0,
                                        view.ceiling, vehicle_),
                    {},
                    {},
                    0};
  crossing.ahead_m = drive_on(crossing.profile, view.speed_mps, until_m);
  crossing.most_m = drive_on(crossing.profile, view.speed_mps, until_m, comfort_acceleration_mps2_);
  crossing.steps_of_others =
      static_cast<int>(std::max(crossing.ahead_m.size(), crossing.most_m.size())) + gap.after;
  return crossing;
}

/// None also marks those who only cross.
std::optional<std::string> RightOfWay::who_comes(const StopPoint& place, const View& view,
                                                 Gap gap) {
  const Crossing way = crossing_of(place, view, gap);
  const StGraph occupancy(way.profile, view.traffic, view.t_s, way.steps_of_others,
                          kCrossingMargin_m);
  const geometry::LinePosition at =
      task_.line.project(view.path.pose_at(view.path_s_m).position(), view.s_m);
  const VehicleOnLine vehicle{task_.line, view.s_m, at.d_m, vehicle_.width_m};
  std::vector<bool> following;
  for (const Obstacle& obstacle : view.traffic.obstacles) {
    following.push_back(is_following(obstacle, view.t_s, vehicle));
  }
  const Others others{crossing_now(way.profile, occupancy, view), std::move(following)};
  auto met = first_met(occupancy, others, way.ahead_m, gap);
  if (!met) met = first_met(occupancy, others, way.most_m, gap);
  if (!met && task_.others_within && gap.after == kGapToTake.after) {
    met = who_speeds_on(way.profile, way.ahead_m, occupancy, others, view, gap);
  }
  if (met) {
    const Obstacle& obstacle = view.traffic.obstacles[met->obstacle];
    return fmt::format("{}: {} {} would be met in {:.1f} s", place.name, obstacle.kind, obstacle.id,
                       met->after_s);
  }
  crossing_ = others.crossing;
  return std::nullopt;
}

/// The first of those who may come from where nothing is seen that would be met, driving on; not of
/// those in whose way the vehicle is already.
std::optional<RightOfWay::Hidden> RightOfWay::who_hidden_is_met(std::size_t stop_point,
                                                                const View& view) {
  HiddenTraffic::MayCome hidden = hidden_.towards(stop_point, *view.sight, view.t_s);
  const double front_m = view.s_m + vehicle_.front_m();
  for (std::size_t i = hidden.cars.size(); i-- > 0;) {
    if (hidden.in_the_way_from_m[i] > front_m) continue;
    hidden.cars.erase(hidden.cars.begin() + static_cast<std::ptrdiff_t>(i));
    hidden.in_the_way_from_m.erase(hidden.in_the_way_from_m.begin() +
                                   static_cast<std::ptrdiff_t>(i));
  }
  const Crossing way = crossing_of(task_.stop_points[stop_point], view, kGapToTake);
  const StGraph occupancy(way.profile, Traffic{hidden.cars}, view.t_s, way.steps_of_others,
                          kCrossingMargin_m);
  const std::vector<bool> nobody(hidden.cars.size(), false);
  const auto met = first_met(occupancy, {nobody, nobody}, way.ahead_m, kGapToTake);
  if (!met) return std::nullopt;
  return Hidden{std::move(hidden.cars[met->obstacle]), hidden.in_the_way_from_m[met->obstacle]};
}

/// Of the next place: the vehicle creeps to where it is not in anybody's way yet.
std::optional<std::string> RightOfWay::who_may_come(const StopPoint& place, const View& view) {
  if (!view.sight || !is_next(place)) return std::nullopt;
  const std::optional<Hidden> somebody = who_hidden_is_met(next_, view);
  if (!somebody) return std::nullopt;
  if (looks_since_s_ && view.t_s - *looks_since_s_ > kLooks_s) {
    creeps_ = true;
    return std::nullopt;
  }
  creeps_to_m_ = std::max(place.s_m, somebody->in_the_way_from_m - kBesideLane_m);
  const bool stands_there = view.speed_mps < kAtRest_mps && left_m(place, view) < kAtLine_m;
  if (stands_there && !looks_since_s_) looks_since_s_ = view.t_s;
  return fmt::format("{}: {} may come {}", place.name, somebody->car.kind, somebody->car.id);
}

}  // namespace roadbed::planning::right_of_way
