#include "roadbed/tools/simulation/closed_loop.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <optional>
#include <utility>

#include "roadbed/control/lower_controller.h"
#include "roadbed/control/stanley.h"
#include "roadbed/planning/speed_ceiling.h"
#include "roadbed/tools/simulation/decision.h"
#include "roadbed/tools/simulation/lead.h"
#include "roadbed/tools/simulation/observer.h"
#include "roadbed/tools/simulation/path_keeper.h"
#include "roadbed/tools/simulation/safety.h"

namespace roadbed::tools {
namespace {

constexpr double kControlStep_s = 0.01;
constexpr int kControlStepsPerCycle = 10;
constexpr double kSideMargin_m = 0.1;  // a lead is what the body would touch, or nearly
constexpr double kHoldingBrake_mps2 = -1.0;
constexpr double kPassOffset_m = 0.5;  // off the reference line this far is passing

/// Distance ahead that matters: to brake comfortably, and the gap to keep.
double look_ahead_m(double speed_mps, const DecisionOptions& options) {
  return 20.0 + options.standstill_gap_m + options.headway_s * speed_mps +
         0.5 * speed_mps * speed_mps / options.deceleration_mps2;
}

planning::SpeedCeiling ceiling_of(const Scenario& scenario, const World& world) {
  return planning::speed_ceiling(
      world.line, scenario.vehicle,
      {.desired_speed_mps = scenario.options.desired_speed_mps,
       .max_lateral_acceleration_mps2 = scenario.options.max_lateral_acceleration_mps2,
       .deceleration_mps2 = scenario.options.comfort_deceleration_mps2});
}

class ClosedLoop {
 public:
  ClosedLoop(const Scenario& scenario, const World& world, const LoopOptions& options)
      : scenario_(scenario),
        world_(world),
        options_(options),
        ceiling_(ceiling_of(scenario, world)),
        cruise_(cruise_options_),
        sensors_(scenario.noise, scenario.seed),
        keeper_(scenario, world, {options.max_tracking_error_m, options.max_heading_error_rad}),
        observer_(world, scenario.vehicle) {
    decision_options_.deceleration_mps2 = scenario.options.comfort_deceleration_mps2;
    truth_.motion.pose = world.start;
    truth_.motion.speed_mps = scenario.start_speed_mps;
    const planning::ReferencePoint on_line =
        world.line.at(world.line.project(world.start.position(), 0.0).s_m);
    truth_.motion.steering_rad =
        std::clamp(std::atan(scenario.vehicle.wheelbase_m * on_line.curvature_per_m),
                   -scenario.vehicle.max_steering_rad, scenario.vehicle.max_steering_rad);
  }

  Drive run() {
    const auto cycles = static_cast<int>(std::ceil(10.0 * scenario_.duration_s - 1e-9));
    for (int cycle = 0; cycle < cycles && !is_over_; ++cycle) {
      plan_and_decide();
      record();
      for (int i = 0; i < kControlStepsPerCycle && !is_over_; ++i) control_step();
    }
    finish();
    return std::move(drive_);
  }

 private:
  double t_s() const { return kControlStep_s * steps_; }

  void plan_and_decide() {
    const auto begin = std::chrono::steady_clock::now();
    const VehicleState measured = sensors_.measure(truth_);
    keeper_.plan(t_s(), measured, set_speed_mps_);
    front_s_m_ = keeper_.s_m();
    DriveCycle cycle{.t_s = t_s(),
                     .from_measurement = keeper_.from_measurement() && !drive_.cycles.empty(),
                     .chosen = keeper_.last_plan().chosen,
                     .plan_reason = keeper_.last_plan().reason,
                     .beyond_the_edge_m = keeper_.beyond_the_edge_m()};
    command(measured, cycle);
    log_path(cycle);
    log_events(cycle);
    drive_.cycles.push_back(std::move(cycle));
    const std::chrono::duration<double, std::milli> took = std::chrono::steady_clock::now() - begin;
    if (options_.on_cycle) options_.on_cycle(took.count());
  }

  /// Set speed, cruise control and safety layer: the desired acceleration until the next cycle.
  void command(const VehicleState& measured, DriveCycle& cycle) {
    const double speed = measured.motion.speed_mps;
    const double to_goal_m = world_.line.goal_s_m() - keeper_.s_m();
    const double look_m = std::min(look_ahead_m(speed, decision_options_),
                                   std::max(0.0, to_goal_m) + scenario_.vehicle.front_m());
    const std::optional<Lead> lead =
        find_lead(keeper_.expected_path(), keeper_.s_m(), look_m, world_.obstacles, t_s(),
                  scenario_.vehicle, kSideMargin_m);
    if (lead) cycle.lead = {world_.obstacles[lead->obstacle].id, lead->gap_m, lead->speed_mps};
    const SpeedAnswer answer = choose_speed(question(measured, lead), decision_options_);
    std::optional<control::LeadMeasurement> seen;
    if (lead) seen = sensors_.measure(*lead, truth_.motion.speed_mps);
    command_mps2_ = cruise_.update(speed, measured.acceleration_mps2, answer.set, seen);
    saturated_ += std::abs(command_mps2_) >= cruise_options_.max_command_mps2 ? 1 : 0;
    if (answer.hold) command_mps2_ = std::min(command_mps2_, kHoldingBrake_mps2);
    set_speed_mps_ = answer.set.speed_mps;
    explain(answer, lead, speed, cycle);
  }

  SpeedQuestion question(const VehicleState& measured, const std::optional<Lead>& lead) const {
    return {.ceiling = ceiling_,
            .s_m = keeper_.s_m(),
            .goal_s_m = world_.line.goal_s_m(),
            .speed_mps = measured.motion.speed_mps,
            .acceleration_mps2 = measured.acceleration_mps2,
            .lead = lead,
            .lead_name = lead ? lead_name(*lead) : "",
            .path_left_m = path_left_m(lead)};
  }

  /// How far the kept path goes when nothing is feasible. A lead on it bounds the speed by itself.
  std::optional<double> path_left_m(const std::optional<Lead>& lead) const {
    if (keeper_.last_plan().chosen) return std::nullopt;
    if (keeper_.something_is_in_the_way() && !lead) return 0.0;
    return keeper_.checked_ahead_m();
  }

  std::string lead_name(const Lead& lead) const {
    const planning::Obstacle& obstacle = world_.obstacles[lead.obstacle];
    return fmt::format("{} {}", obstacle.kind, obstacle.id);
  }

  void explain(const SpeedAnswer& answer, const std::optional<Lead>& lead, double speed_mps,
               DriveCycle& cycle) {
    cycle.behaviour = answer.behaviour;
    cycle.reason = answer.reason;
    const double offset_m = keeper_.path().lateral_at(keeper_.s_m()).d_m;
    const double end_m = cycle.chosen ? cycle.chosen->end_d_m : offset_m;
    if (answer.behaviour == Behaviour::cruise &&
        std::max(std::abs(offset_m), std::abs(end_m)) > kPassOffset_m) {
      cycle.behaviour = Behaviour::pass;
      cycle.reason = fmt::format("the way is free {:.1f} m {} of the reference line",
                                 std::abs(end_m), end_m < 0.0 ? "right" : "left");
    }
    if (!lead) return;
    if (const auto braking = emergency_deceleration_mps2(speed_mps, *lead)) {
      command_mps2_ = std::min(command_mps2_, -*braking);
      cycle.behaviour = Behaviour::emergency;
      cycle.reason =
          fmt::format("braking at {:.1f} m/s²: {} is {:.1f} m ahead, closing at {:.1f} m/s",
                      *braking, lead_name(*lead), lead->gap_m, speed_mps - lead->speed_mps);
    }
  }

  void log_path(DriveCycle& cycle) const {
    for (const geometry::TrajectoryPoint& point : keeper_.last_plan().trajectory.points()) {
      cycle.path.push_back(world_.road_map.to_source({point.x_m, point.y_m}));
    }
  }

  void log_events(const DriveCycle& cycle) {
    const auto log = [&](EventLevel level, std::string text) {
      drive_.events.push_back({cycle.t_s, level, std::move(text)});
    };
    if (cycle.from_measurement) {
      log(EventLevel::warning, "planned from the measured state: tracking was too far off");
    }
    const DriveCycle* last = drive_.cycles.empty() ? nullptr : &drive_.cycles.back();
    if (!cycle.chosen && (!last || last->chosen)) {
      log(EventLevel::warning, "nothing is feasible: " + cycle.plan_reason);
    }
    if (cycle.chosen && cycle.beyond_the_edge_m > 0.0 &&
        (!last || last->beyond_the_edge_m < cycle.beyond_the_edge_m)) {
      log(EventLevel::info, fmt::format("no candidate keeps to the lanes; up to {:.1f} m beyond",
                                        cycle.beyond_the_edge_m));
    }
    if (cycle.behaviour == Behaviour::emergency &&
        (!last || last->behaviour != Behaviour::emergency)) {
      log(EventLevel::warning, "emergency braking: " + cycle.reason);
    }
    const std::string lead = cycle.lead ? cycle.lead->id : "";
    const std::string last_lead = last && last->lead ? last->lead->id : "";
    if (lead != last_lead) {
      log(EventLevel::info,
          lead.empty() ? last_lead + " is no longer ahead" : lead + " is ahead on the path");
    }
  }

  control::TrackingError tracking_error_of(const geometry::Pose2& pose) {
    const double wheelbase_m = scenario_.vehicle.wheelbase_m;
    const Eigen::Vector2d front = pose * Eigen::Vector2d(wheelbase_m, 0.0);
    front_s_m_ = keeper_.path().nearest_front_s_m(front, wheelbase_m, front_s_m_);
    return control::tracking_error(pose, wheelbase_m,
                                   keeper_.path().front_pose_at(front_s_m_, wheelbase_m));
  }

  void control_step() {
    const VehicleState measured = sensors_.measure(truth_);
    const control::TrackingError error = tracking_error_of(measured.motion.pose);
    const double wanted =
        control::stanley_steering_rad(error, measured.motion.speed_mps, scenario_.vehicle);
    truth_.acceleration_mps2 =
        control::actuate(truth_.acceleration_mps2, command_mps2_, kControlStep_s);
    truth_.motion = control::step(
        truth_.motion,
        {.acceleration_mps2 = truth_.acceleration_mps2,
         .steering_rate_radps = (wanted - truth_.motion.steering_rad) / kControlStep_s},
        kControlStep_s, scenario_.vehicle);
    if (truth_.motion.speed_mps <= 0.0 && truth_.acceleration_mps2 < 0.0) {
      truth_.acceleration_mps2 = 0.0;  // it stands
    }
    ++steps_;
    observer_.look(t_s(), truth_);
    check_end();
  }

  double true_s_m() const {
    return world_.line.project(truth_.motion.pose.position(), keeper_.s_m()).s_m;
  }

  void check_end() {
    if (!observer_.touched().empty()) {
      end(Outcome::collision, fmt::format("touched {} at {:.1f} m/s after {:.2f} s",
                                          observer_.touched(), truth_.motion.speed_mps, t_s()));
      drive_.events.push_back({t_s(), EventLevel::fault, drive_.verdict.text});
    } else if (truth_.motion.speed_mps <= 0.0) {
      const double missed_m = true_s_m() - world_.line.goal_s_m();
      if (std::abs(missed_m) > options_.goal_tolerance_m) return;
      end(Outcome::goal_reached, fmt::format("goal reached after {:.2f} s, {:.2f} m {} it", t_s(),
                                             std::abs(missed_m), missed_m < 0 ? "before" : "past"));
    }
  }

  void end(Outcome outcome, std::string text) {
    drive_.verdict = {outcome, t_s(), std::move(text)};
    is_over_ = true;
  }

  void finish() {
    record();
    if (!drive_.cycles.empty()) {
      drive_.saturated_share =
          static_cast<double>(saturated_) / static_cast<double>(drive_.cycles.size());
    }
    drive_.trajectory = geometry::Trajectory(std::move(rows_));
    if (is_over_) return;
    const double left_m = world_.line.goal_s_m() - true_s_m();
    const bool stands = truth_.motion.speed_mps <= 0.0;
    end(stands ? Outcome::stopped : Outcome::timed_out,
        fmt::format("{} {:.1f} m before the goal after {:.1f} s: {}",
                    stands ? "stands" : "still drives", left_m, t_s(),
                    drive_.cycles.back().reason));
  }

  void record() {
    rows_.push_back(observer_.row(t_s(), truth_));
    observer_.look(t_s(), truth_);
    const double s_m = true_s_m();
    const control::TrackingError error = tracking_error_of(truth_.motion.pose);
    drive_.samples.push_back({.t_s = t_s(),
                              .s_m = s_m,
                              .set_speed_mps = set_speed_mps_,
                              .speed_limit_mps = world_.line.corridor_at(s_m).speed_limit_mps,
                              .command_mps2 = command_mps2_,
                              .cross_track_m = error.cross_track_m,
                              .heading_error_rad = error.heading_rad,
                              .clearance_m = observer_.take_clearance_m(),
                              .off_road_m = observer_.off_road_m(truth_)});
  }

  const Scenario& scenario_;
  const World& world_;
  const LoopOptions& options_;
  DecisionOptions decision_options_;
  control::CruiseOptions cruise_options_;
  planning::SpeedCeiling ceiling_;
  control::CruiseControl cruise_;
  Sensors sensors_;
  PathKeeper keeper_;
  Observer observer_;

  VehicleState truth_;
  int steps_ = 0;
  double front_s_m_ = 0.0;  ///< station of the front axle's nearest place on the path
  double command_mps2_ = 0.0;
  double set_speed_mps_ = 0.0;
  int saturated_ = 0;
  bool is_over_ = false;
  std::vector<geometry::TrajectoryPoint> rows_;
  Drive drive_;
};

}  // namespace

Drive drive(const Scenario& scenario, const World& world, const LoopOptions& options) {
  return ClosedLoop(scenario, world, options).run();
}

}  // namespace roadbed::tools
