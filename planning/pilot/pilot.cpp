#include "roadbed/planning/pilot/pilot.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <stdexcept>
#include <utility>

#include "roadbed/planning/behaviour/planner.h"
#include "roadbed/planning/behaviour/route_line.h"
#include "roadbed/planning/pilot/cruise_speed.h"
#include "roadbed/planning/pilot/first_contact.h"
#include "roadbed/planning/pilot/path_tracking.h"
#include "roadbed/planning/pilot/planned_trajectory.h"
#include "roadbed/planning/route/match_place.h"
#include "roadbed/planning/route/router.h"
#include "roadbed/planning/speed/lead.h"

namespace roadbed::planning::inline pilot {
namespace {

constexpr double kTakenAway_m = 12.0;      // from its line, farther than planning leads
constexpr double kAcross = -0.2;           // cosine, of who stands a little more than across a lane
constexpr double kAsksAgainAfter_s = 1.0;  // for a route, where there was none
constexpr double kYellow_s = 3.0;          // how long one lasts [VwV-StVO to § 37: 3 s at 50 km/h]
constexpr double kForLong_s = 1e6;
constexpr double kAtGoal_m = 1.0;
constexpr double kTurnedAway = 0.95;                // cosine, of who does not stand along its path
constexpr double kBefore_m = 0.5, kBeside_m = 0.1;  // of who stands, for a trajectory

void refuse_unusable(const PilotView& view) {
  const auto refuse = [](const std::string& what) {
    throw std::invalid_argument("Pilot: " + what);
  };
  const auto is_finite = [](const geometry::Pose2& pose) {
    return std::isfinite(pose.x_m) && std::isfinite(pose.y_m) && std::isfinite(pose.heading_rad);
  };
  if (!is_finite(view.ego.map_from_vehicle) || !std::isfinite(view.ego.speed_mps) ||
      !std::isfinite(view.ego.acceleration_mps2) || !std::isfinite(view.ego.steering_rad)) {
    refuse("the vehicle's state is not finite");
  }
  for (const Detection& object : view.objects) {
    const bool is_usable = is_finite(object.centre) && std::isfinite(object.speed_mps) &&
                           object.length_m > 0.0 && object.width_m > 0.0;
    if (!is_usable) refuse("an object's numbers are not usable: " + object.id);
  }
}

/// A light whose future nobody tells: green stays, yellow becomes red, red stays.
std::vector<LightPhase> phases_of(LightColour colour, double since_s, double t_s) {
  if (colour != LightColour::yellow) return {{colour, kForLong_s}};
  return {{LightColour::yellow, std::max(0.1, kYellow_s - (t_s - since_s))},
          {LightColour::red, kForLong_s}};
}

struct Found {
  std::optional<Route> route;
  std::string reason;  ///< why there is none
};

bool heads_along(const geometry::Pose2& map_from_vehicle, double heading_rad) {
  return std::cos(map_from_vehicle.heading_rad - heading_rad) >= kAcross;
}

/// Far from it, or behind its goal, or turned around.
/// @param near_s_m  where it was: the line may come over itself.
bool is_away_from(const ReferenceLine& line, const VehicleState& ego, double near_s_m) {
  const Eigen::Vector2d here = ego.map_from_vehicle.position();
  const double s_m = line.project(here, near_s_m).s_m;
  const ReferencePoint foot = line.at(s_m);
  const double past_goal_m = ego.speed_mps > 0.0 ? kTakenAway_m : kAtGoal_m;
  return (here - foot.in_map).norm() > kTakenAway_m || s_m > line.goal_s_m() + past_goal_m ||
         !heads_along(ego.map_from_vehicle, foot.heading_rad);
}

/// From the lane that fits the vehicle best of those from which there is a route.
Found route_from(const map::RoadMap& road_map, const geometry::Pose2& map_from_vehicle,
                 const RoutePlace& goal) {
  Router router(road_map);
  Found found{.route = {}, .reason = "the vehicle stands along no lane"};
  for (const RoutePlace& start : places_to_set_off(road_map, map_from_vehicle)) {
    RouteAnswer answer = router.find(start, goal);
    if (answer.route) return {std::move(answer.route), ""};
    found.reason = std::move(answer.reason);
  }
  return found;
}

}  // namespace

class Pilot::Impl {
 public:
  explicit Impl(PilotSetup setup)
      : setup_(checked(std::move(setup))),
        others_(*setup_.road_map, setup_.tracker),
        cruise_(setup_.driving) {}

  PilotAnswer step(const PilotView& view) {
    refuse_unusable(view);
    if (view.has_objects) {
      others_.observe(view.t_s, view.objects);
    } else {
      others_.foresee(view.t_s);
    }
    const bool has_new_light = take_lights(view);
    keep_route(view);
    if (!planner_) return without_route(view);
    task_->obstacles = others_.obstacles(view.ego.map_from_vehicle);
    task_->other_levels.leave_out(view.ego.map_from_vehicle, view.t_s, task_->obstacles);
    if (has_new_light) find_stop_points();
    return drive(view);
  }

  const PerceivedTraffic& others() const { return others_; }

 private:
  static PilotSetup checked(PilotSetup setup) {
    if (!setup.road_map) throw std::invalid_argument("Pilot: there is no map");
    if (setup.goal.lane.index >= setup.road_map->lanes().size()) {
      throw std::invalid_argument("Pilot: the goal's lane is not in the map");
    }
    return setup;
  }

  // Lights.

  struct Light {
    LightColour colour;
    double since_s;
  };

  /// @returns whether one is among them that has never been named.
  bool take_lights(const PilotView& view) {
    bool has_new = false;
    for (const SeenLight& seen : view.lights) {
      const auto known = std::ranges::find_if(
          lights_, [&](const LightCycle& light) { return light.signals.front() == seen.signal; });
      const auto at = static_cast<std::size_t>(known - lights_.begin());
      if (known == lights_.end()) {
        lights_.push_back({.signals = {seen.signal}, .pointer = "", .phases = {}});
        shown_.push_back({seen.colour, view.t_s});
        has_new = true;
      }
      if (shown_[at].colour != seen.colour) shown_[at] = {seen.colour, view.t_s};
      lights_[at].offset_s = view.t_s;
      lights_[at].phases = phases_of(seen.colour, shown_[at].since_s, view.t_s);
    }
    if (task_) task_->lights = lights_;
    return has_new;
  }

  // The route.

  void keep_route(const PilotView& view) {
    if (decision_.detour) return take(*std::exchange(decision_.detour, std::nullopt));
    if (planner_ && !is_away_from(task_->line, view.ego, planner_->replanner().s_m())) return;
    if (stands_at_goal(view.ego)) return planner_.reset();
    if (view.t_s < next_question_s_) return;
    next_question_s_ = view.t_s + kAsksAgainAfter_s;
    Found found = route_from(*setup_.road_map, view.ego.map_from_vehicle, setup_.goal);
    why_no_route_ = std::move(found.reason);
    planner_.reset();  // refers to the task
    if (found.route) begin(*std::move(found.route), view);
  }

  void begin(Route route, const PilotView& view) {
    RouteLine drawn =
        line_along(*setup_.road_map, route, setup_.vehicle, setup_.driving.desired_speed_mps);
    OtherLevels other_levels(*setup_.road_map, route);
    task_ = std::make_unique<DrivingTask>(DrivingTask{.kept_map = setup_.road_map,
                                                      .field = setup_.occupied,
                                                      .start = view.ego.map_from_vehicle,
                                                      .route = std::move(route),
                                                      .line = std::move(drawn.line),
                                                      .line_options = drawn.options,
                                                      .other_levels = std::move(other_levels),
                                                      .obstacles = {},
                                                      .others_within = others_.expected(),
                                                      .sight_m = setup_.sight_m,
                                                      .lights = lights_});
    restart();
  }

  void take(const Detour& detour) {
    planner_.reset();
    detour.lead(*task_);
    restart();
  }

  void find_stop_points() {
    task_->stop_points = stop_points(*setup_.road_map, task_->route, task_->line, task_->lights);
  }

  void restart() {
    find_stop_points();
    planner_.emplace(PlannerSetup{.task = *task_,
                                  .vehicle = setup_.vehicle,
                                  .driving = setup_.driving,
                                  .planner = setup_.planner});
    front_s_m_.reset();
  }

  bool stands_at_goal(const VehicleState& ego) const {
    const map::Lane& lane = setup_.road_map->lane(setup_.goal.lane);
    const Eigen::Vector2d off =
        lane.pose_at(setup_.goal.s_m).inverse() * ego.map_from_vehicle.position();
    return ego.speed_mps <= 0.0 && std::abs(off.x()) <= kAtGoal_m &&
           std::abs(off.y()) <= 0.5 * lane.width_m(setup_.goal.s_m);
  }

  PilotAnswer without_route(const PilotView& view) const {
    PilotAnswer answer{.trajectory = stopping_trajectory(view.t_s, view.ego),
                       .acceleration_mps2 = 0.0,
                       .steering_rad = 0.0,
                       .decision = {}};
    answer.acceleration_mps2 = answer.trajectory.points().front().acceleration_mps2;
    answer.decision.behaviour = Behaviour::stop;
    answer.is_at_goal = stands_at_goal(view.ego);
    answer.decision.reason =
        answer.is_at_goal ? "stands at the goal" : "no route leads to the goal: " + why_no_route_;
    return answer;
  }

  // The drive.

  PilotAnswer drive(const PilotView& view) {
    decision_ =
        planner_->decide({.t_s = view.t_s, .measured = view.ego, .speed_controller = cruise_});
    const LateralReplanner& replanner = planner_->replanner();
    const PlannedPath path = replanner.expected_path();
    if (!front_s_m_) front_s_m_ = replanner.s_m() + setup_.vehicle.wheelbase_m;
    const control::TrackingError error =
        tracking_error(path, view.ego.map_from_vehicle, setup_.vehicle.wheelbase_m, *front_s_m_);
    PilotAnswer answer{.trajectory = trajectory_of(view),
                       .acceleration_mps2 = decision_.acceleration_mps2,
                       .steering_rad = tracking_steering_rad(
                           error, view.ego.speed_mps, setup_.vehicle, decision_.most_lateral_mps2),
                       .decision = decision_};
    answer.is_at_goal = stands_at_goal(view.ego);
    return answer;
  }

  /// Past what was planned it leads back to the line, or stays beside it where somebody would be
  /// met on the way back; straight on where the vehicle is turned away from its path.
  geometry::Trajectory trajectory_of(const PilotView& view) const {
    const LateralReplanner& replanner = planner_->replanner();
    const PlannedPath leads_back = replanner.expected_path();
    const double turned =
        leads_back.pose_at(replanner.s_m()).heading_rad - view.ego.map_from_vehicle.heading_rad;
    if (std::cos(turned) < kTurnedAway) return stopping_trajectory(view.t_s, view.ego);
    const auto along = [&](const PlannedPath& path) {
      return planned_trajectory({path, replanner.s_m(), stops_by_s_m(path, view.t_s)}, view.t_s,
                                view.ego, decision_, setup_.vehicle);
    };
    geometry::Trajectory back = along(leads_back);
    const double met_s = first_contact_s(back, setup_.vehicle, task_->obstacles);
    if (std::isinf(met_s)) return back;
    geometry::Trajectory beside = along(replanner.path());
    return first_contact_s(beside, setup_.vehicle, task_->obstacles) > met_s ? beside : back;
  }

  /// What a trajectory that is driven to its end has to stop before: the halt, who stands on the
  /// path, and places to wait at beyond what was planned.
  double stops_by_s_m(const PlannedPath& path, double t_s) const {
    const double s_m = planner_->replanner().s_m();
    const double planned_m = decision_.drive.back().ahead_m;
    double by_s_m =
        decision_.halt_m ? s_m + *decision_.halt_m : std::numeric_limits<double>::infinity();
    std::vector<bool> drives;
    for (const Obstacle& other : task_->obstacles) drives.push_back(!is_standing(other, t_s));
    const double look_m = farthest_m(decision_);
    const auto stands =
        find_lead(path, s_m, look_m, task_->obstacles, t_s, setup_.vehicle, kBeside_m, drives);
    if (stands) by_s_m = std::min(by_s_m, s_m + stands->gap_m - kBefore_m);
    for (const StopPoint& place : task_->stop_points) {
      const double at_s_m = place.s_m - setup_.vehicle.front_m() - kBefore_m;
      const bool is_green =
          place.light && colour_at(lights_[*place.light], t_s) == LightColour::green;
      if (at_s_m > s_m + planned_m && !is_green) by_s_m = std::min(by_s_m, at_s_m);
    }
    return by_s_m;
  }

  PilotSetup setup_;
  PerceivedTraffic others_;
  std::vector<LightCycle> lights_;  ///< of those that were named once
  std::vector<Light> shown_;        ///< what each of them shows
  CruiseSpeed cruise_;
  std::unique_ptr<DrivingTask> task_;  ///< none: no route so far
  std::optional<Planner> planner_;     ///< of the task
  PlannerCommand decision_;            ///< the last
  std::optional<double> front_s_m_;    ///< station of the front axle's nearest place on the path
  double next_question_s_ = -std::numeric_limits<double>::infinity();
  std::string why_no_route_;
};

Pilot::Pilot(PilotSetup setup) : impl_(std::make_unique<Impl>(std::move(setup))) {}
Pilot::~Pilot() = default;
Pilot::Pilot(Pilot&&) noexcept = default;
Pilot& Pilot::operator=(Pilot&&) noexcept = default;

PilotAnswer Pilot::step(const PilotView& view) { return impl_->step(view); }
const PerceivedTraffic& Pilot::others() const { return impl_->others(); }

}  // namespace roadbed::planning::pilot
