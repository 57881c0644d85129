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
#include "roadbed/planning/pilot/path_tracking.h"
#include "roadbed/planning/pilot/planned_trajectory.h"
#include "roadbed/planning/route/match_place.h"
#include "roadbed/planning/route/router.h"

namespace roadbed::planning::inline pilot {
namespace {

constexpr double kTakenAway_m = 12.0;      // from its line, farther than planning leads
constexpr double kAsksAgainAfter_s = 1.0;  // for a route, where there was none
constexpr double kYellow_s = 3.0;          // how long one lasts [VwV-StVO to § 37: 3 s at 50 km/h]
constexpr double kForLong_s = 1e6;
constexpr double kAtGoal_m = 1.0;

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

/// Lanes under the vehicle that it heads along; else the one that fits it best nearby, as on a
/// driveway or across a lane.
std::vector<RoutePlace> places_to_set_off(const map::RoadMap& road_map,
                                          const geometry::Pose2& map_from_vehicle) {
  constexpr double reach_m = 3.0;
  std::vector<RoutePlace> places = places_under(road_map, map_from_vehicle);
  if (!places.empty()) return places;
  for (const PlaceCandidate& near :
       match_place(road_map, map_from_vehicle.position(), map_from_vehicle.heading_rad,
                   {.reach_m = reach_m})) {
    if (near.verdict != MatchVerdict::chosen) continue;
    places.push_back({near.place, near.sense == Sense::against ? Sense::against : Sense::along});
  }
  return places;
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
    others_.observe(view.t_s, view.objects);
    const bool has_new_light = take_lights(view);
    keep_route(view);
    if (!planner_) return without_route(view);
    task_->obstacles = others_.obstacles(view.ego.map_from_vehicle);
    task_->other_levels.leave_out(view.ego.map_from_vehicle, view.t_s, task_->obstacles);
    if (has_new_light) restart();
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
    const Eigen::Vector2d here = view.ego.map_from_vehicle.position();
    const bool is_away = task_ && std::abs(task_->line.project(here).d_m) > kTakenAway_m;
    if ((task_ && !is_away) || view.t_s < next_question_s_) return;
    next_question_s_ = view.t_s + kAsksAgainAfter_s;
    Found found = route_from(*setup_.road_map, view.ego.map_from_vehicle, setup_.goal);
    why_no_route_ = std::move(found.reason);
    if (found.route) begin(*std::move(found.route), view);
  }

  void begin(Route route, const PilotView& view) {
    RouteLine drawn =
        line_along(*setup_.road_map, route, setup_.vehicle, setup_.driving.desired_speed_mps);
    OtherLevels other_levels(*setup_.road_map, route);
    planner_.reset();
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

  /// Where the vehicle has to wait is found anew; the plan goes on from where it is.
  void restart() {
    task_->stop_points = stop_points(*setup_.road_map, task_->route, task_->line, task_->lights);
    planner_.emplace(PlannerSetup{.task = *task_,
                                  .vehicle = setup_.vehicle,
                                  .driving = setup_.driving,
                                  .planner = setup_.planner});
    front_s_m_.reset();
  }

  PilotAnswer without_route(const PilotView& view) const {
    PilotAnswer answer{.trajectory = stopping_trajectory(view.t_s, view.ego),
                       .acceleration_mps2 = 0.0,
                       .steering_rad = 0.0,
                       .decision = {}};
    answer.acceleration_mps2 = answer.trajectory.points().front().acceleration_mps2;
    answer.decision.behaviour = Behaviour::stop;
    answer.decision.reason = "no route leads to the goal: " + why_no_route_;
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
    PilotAnswer answer{
        .trajectory = planned_trajectory({path, replanner.s_m()}, view.t_s, view.ego, decision_,
                                         setup_.vehicle),
        .acceleration_mps2 = decision_.acceleration_mps2,
        .steering_rad = tracking_steering_rad(error, view.ego.speed_mps, setup_.vehicle),
        .decision = decision_};
    const double missed_m = replanner.s_m() - task_->line.goal_s_m();
    answer.is_at_goal = view.ego.speed_mps <= 0.0 && std::abs(missed_m) <= kAtGoal_m;
    return answer;
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
