#include "roadbed/tools/simulation/drive.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <memory>
#include <utility>

#include "roadbed/control/lower_controller.h"
#include "roadbed/control/single_track.h"
#include "roadbed/control/stanley.h"
#include "roadbed/planning/behaviour/planner.h"
#include "roadbed/planning/pilot/cruise_speed.h"
#include "roadbed/planning/pilot/path_tracking.h"
#include "roadbed/tools/simulation/goal_misses.h"
#include "roadbed/tools/simulation/ground_truth_monitor.h"
#include "roadbed/tools/simulation/pedal_model.h"
#include "roadbed/tools/simulation/road_departure.h"
#include "roadbed/tools/simulation/sensors.h"
#include "roadbed/tools/simulation/tracked_traffic.h"
#include "roadbed/tools/simulation/trajectory_follower.h"

namespace roadbed::tools::inline simulation {
namespace {

constexpr double kControlStep_s = 0.01;
constexpr int kControlStepsPerCycle = 10;
static_assert(kControlStep_s * kControlStepsPerCycle == geometry::kLongitudinal.cycle_s);

/// A route as far as a length along it.
planning::Route first_part(planning::Route route, double length_m) {
  double left_m = length_m;
  for (std::size_t i = 0; i < route.legs.size(); ++i) {
    planning::RouteLeg& leg = route.legs[i];
    if (left_m < leg.length_m) {
      const double part = std::max(0.0, left_m) / leg.length_m;
      leg.to_s_m = leg.from_s_m + part * (leg.to_s_m - leg.from_s_m);
      leg.exit = planning::LegExit::goal;
      route.legs.resize(i + 1);
      break;
    }
    left_m -= leg.length_m;
  }
  return route;
}

/// The cruise control behind the sensors of the lead.
class MeasuredCruise : public planning::CruiseSpeed {
 public:
  MeasuredCruise(Sensors& sensors, const planning::VehicleState& truth,
                 const planning::DrivingOptions& driving)
      : CruiseSpeed(driving), sensors_(sensors), truth_(truth) {}

 private:
  bool sees(double t_s) override { return sensors_.sees(t_s); }

  control::LeadMeasurement measure(const planning::Lead& lead,
                                   const planning::VehicleState&) override {
    return sensors_.measure(lead, truth_.speed_mps);
  }

  Sensors& sensors_;
  const planning::VehicleState& truth_;
};

class ClosedLoop {
 public:
  ClosedLoop(const Scenario& scenario, World& world, const LoopOptions& options)
      : scenario_(scenario),
        world_(world),
        options_(options),
        flow_(world.drivers, world.obstacles, scenario.duration_s, {}),
        sensors_(scenario.noise, scenario.seed),
        cruise_(sensors_, truth_, scenario.options),
        drive_(begun(world, options)),
        planner_(setup()),
        observer_(world, scenario.vehicle) {
    truth_.map_from_vehicle = world.start;
    truth_.speed_mps = scenario.start_speed_mps;
    truth_.steering_rad = start_steering_rad();
    if (drive_.believed) {
      others_.emplace(world, scenario);
      drive_.believed->sight_m = others_->range_m();
      drive_.believed->others_within = others_->expected();
    }
    if (scenario.pedals) {
      foot_.emplace(GradeProfile(world.road_map, world.route, world.line));
    }
  }

  Drive run() {
    const auto cycles = static_cast<int>(std::ceil(10.0 * scenario_.duration_s - 1e-9));
    for (int cycle = 0; cycle < cycles && !is_over_; ++cycle) {
      flow_.step({geometry::body_at(truth_.map_from_vehicle, scenario_.vehicle), truth_.speed_mps});
      world_.other_levels.leave_out(truth_.map_from_vehicle, t_s(), world_.obstacles);
      plan_and_decide();
      record();
      if (is_last_cycle()) return left();
      for (int i = 0; i < kControlStepsPerCycle && !is_over_; ++i) control_step();
    }
    finish();
    return std::move(drive_);
  }

 private:
  static Drive begun(const World& world, const LoopOptions& options) {
    Drive drive;
    if (!options.predicts || options.outside_planner) return drive;
    drive.believed = std::make_shared<planning::DrivingTask>(world);
    drive.believed->obstacles.clear();
    return drive;
  }

  planning::PlannerSetup setup() const {
    return {.task = drive_.believed ? *drive_.believed : world_,
            .vehicle = scenario_.vehicle,
            .driving = scenario_.options,
            .planner = options_.planner};
  }

  double t_s() const { return kControlStep_s * steps_; }

  /// Of the one that is being planned, or was planned last.
  bool is_last_cycle() const {
    const auto cycle = static_cast<std::size_t>(steps_ / kControlStepsPerCycle);
    return options_.last_cycle == cycle;
  }

  Drive left() {
    drive_.explained = replanner().explained();
    drive_.trajectory = geometry::Trajectory(std::move(rows_));
    return std::move(drive_);
  }

  /// Along the lane, as far as the speed allows at the start.
  double start_steering_rad() const {
    const planning::ReferencePoint on_line =
        world_.line.at(world_.line.project(world_.start.position(), 0.0).s_m);
    const double most =
        planning::most_steering_rad(scenario_.start_speed_mps, scenario_.vehicle,
                                    scenario_.options.max_lateral_acceleration_mps2);
    return std::clamp(std::atan(scenario_.vehicle.wheelbase_m * on_line.curvature_per_m), -most,
                      most);
  }

  const planning::LateralReplanner& replanner() const { return planner_.replanner(); }

  void plan_and_decide() {
    if (options_.outside_planner) return ask_outside();
    const auto begin = std::chrono::steady_clock::now();
    const planning::VehicleState measured = sensors_.measure(truth_);
    const bool has_new_route = command_.detour.has_value();
    if (has_new_route) take(*command_.detour);
    if (others_) {
      drive_.believed->obstacles =
          others_->look(t_s(), geometry::body_at(truth_.map_from_vehicle, scenario_.vehicle),
                        measured.map_from_vehicle);
      world_.other_levels.leave_out(measured.map_from_vehicle, t_s(), drive_.believed->obstacles);
    }
    command_ = planner_.decide({.t_s = t_s(),
                                .measured = measured,
                                .speed_controller = cruise_,
                                .explains = is_last_cycle()});
    const std::chrono::duration<double, std::milli> took = std::chrono::steady_clock::now() - begin;
    if (options_.on_cycle) options_.on_cycle(took.count());
    front_s_m_ = replanner().s_m();
    saturated_ += command_.saturated ? 1 : 0;
    log_cycle(has_new_route);
  }

  /// Before the first trajectory it brakes where it stands.
  void ask_outside() {
    const auto begin = std::chrono::steady_clock::now();
    const planning::VehicleState measured = sensors_.measure(truth_);
    OutsidePlan plan = options_.outside_planner(observe(scenario_, world_, t_s(), measured));
    const std::chrono::duration<double, std::milli> took = std::chrono::steady_clock::now() - begin;
    if (options_.on_cycle) options_.on_cycle(took.count());
    const bool is_new = !plan.trajectory.empty();
    if (is_new) {
      follower_.emplace(in_map(plan.trajectory), scenario_.vehicle);
    } else if (!follower_) {
      const geometry::Pose2& pose = measured.map_from_vehicle;
      const geometry::TrajectoryPoint here{t_s(), pose.x_m, pose.y_m, pose.heading_rad};
      follower_.emplace(geometry::Trajectory({here}), scenario_.vehicle);
    }
    command_ = {};
    command_.acceleration_mps2 =
        follower_->acceleration_mps2(t_s(), measured.map_from_vehicle, measured.speed_mps);
    command_.set_speed_mps = follower_->trajectory().at(t_s()).speed_mps;
    command_.reason = plan.reason.empty() ? "another planner drives" : std::move(plan.reason);
    log_outside(is_new);
  }

  geometry::Trajectory in_map(const geometry::Trajectory& in_source) const {
    std::vector<geometry::TrajectoryPoint> points = in_source.points();
    for (geometry::TrajectoryPoint& point : points) {
      const Eigen::Vector2d place = world_.road_map.to_map({point.x_m, point.y_m});
      point.x_m = place.x();
      point.y_m = place.y();
    }
    return geometry::Trajectory(std::move(points));
  }

  void log_outside(bool is_new) {
    DriveCycle cycle{.t_s = t_s(),
                     .behaviour = command_.behaviour,
                     .reason = command_.reason,
                     .is_outside = is_new,
                     .plan_reason = is_new ? "" : "the planner gave no trajectory"};
    if (is_new) {
      for (const geometry::TrajectoryPoint& point : follower_->trajectory().points()) {
        cycle.path.push_back(world_.road_map.to_source({point.x_m, point.y_m}));
      }
    }
    const DriveCycle* last = drive_.cycles.empty() ? nullptr : &drive_.cycles.back();
    for (DriveEvent& event : events_of(cycle, last)) drive_.events.push_back(std::move(event));
    drive_.cycles.push_back(std::move(cycle));
  }

  /// The vehicle goes on from where it stands; stations of the samples do, too.
  void take(const planning::Detour& detour) {
    const double left_s_m = drive_.last_line_from_s_m + true_s_m();
    drive_.given_up.push_back({t_s(), first_part(std::move(world_.route), s_m_), world_.line});
    detour.lead(world_);
    if (drive_.believed) detour.lead(*drive_.believed);
    planner_ = planning::Planner(setup());
    s_m_ = 0.0;
    drive_.last_line_from_s_m = left_s_m - true_s_m();
    if (foot_) foot_->take_grades(GradeProfile(world_.road_map, world_.route, world_.line));
  }

  void log_cycle(bool has_new_route) {
    DriveCycle cycle{.t_s = t_s(),
                     .behaviour = command_.behaviour,
                     .reason = command_.reason,
                     .is_news = command_.is_news,
                     .from_measurement =
                         replanner().from_measurement() && !drive_.cycles.empty() && !has_new_route,
                     .chosen = replanner().last_plan().chosen,
                     .start = replanner().last_plan().start,
                     .grid = replanner().candidates(),
                     .plan_reason = replanner().last_plan().reason,
                     .beyond_the_edge_m = replanner().beyond_the_edge_m(),
                     .lead = command_.lead,
                     .hypotheses = command_.hypotheses};
    if (others_) {
      cycle.foreseen = others_->foreseen();
      name_in_pictures(cycle);
    }
    for (const geometry::TrajectoryPoint& point : replanner().last_plan().trajectory.points()) {
      cycle.path.push_back(world_.road_map.to_source({point.x_m, point.y_m}));
    }
    const DriveCycle* last = drive_.cycles.empty() ? nullptr : &drive_.cycles.back();
    for (DriveEvent& event : events_of(cycle, last)) drive_.events.push_back(std::move(event));
    drive_.cycles.push_back(std::move(cycle));
  }

  /// The planner knows others by its own numbers.
  void name_in_pictures(DriveCycle& cycle) const {
    for (planning::HypothesisOutcome& hypothesis : cycle.hypotheses) {
      for (planning::StPicture::Part& part : hypothesis.st.parts) {
        if (part.obstacle == planning::StInterval::kNoObstacle) continue;
        part.obstacle = others_->obstacle_of(part.obstacle);
      }
    }
  }

  control::TrackingError tracking_error_of(const geometry::Pose2& pose) {
    if (follower_) return follower_->error_of(pose);
    return planning::tracking_error(replanner().path(), pose, scenario_.vehicle.wheelbase_m,
                                    front_s_m_);
  }

  double acceleration_after_step() {
    if (!foot_) {
      return control::actuate(truth_.acceleration_mps2, command_.acceleration_mps2, kControlStep_s);
    }
    return foot_->press(command_.acceleration_mps2, truth_.speed_mps, s_m_, kControlStep_s);
  }

  void control_step() {
    const planning::VehicleState measured = sensors_.measure(truth_);
    const control::TrackingError error = tracking_error_of(measured.map_from_vehicle);
    const double speed_mps = measured.speed_mps;
    if (follower_) {
      command_.acceleration_mps2 =
          follower_->acceleration_mps2(t_s(), measured.map_from_vehicle, speed_mps);
    }
    const double wanted = planning::tracking_steering_rad(error, speed_mps, scenario_.vehicle,
                                                          command_.most_lateral_mps2);
    truth_.acceleration_mps2 = acceleration_after_step();
    const control::SingleTrackState moved =
        control::step({.pose = truth_.map_from_vehicle,
                       .speed_mps = truth_.speed_mps,
                       .steering_rad = truth_.steering_rad},
                      {.acceleration_mps2 = truth_.acceleration_mps2,
                       .steering_rate_radps = (wanted - truth_.steering_rad) / kControlStep_s},
                      kControlStep_s, scenario_.vehicle);
    truth_.map_from_vehicle = moved.pose;
    truth_.speed_mps = moved.speed_mps;
    truth_.steering_rad = moved.steering_rad;
    if (truth_.speed_mps <= 0.0 && truth_.acceleration_mps2 < 0.0) {
      truth_.acceleration_mps2 = 0.0;  // it stands
    }
    ++steps_;
    observer_.look(t_s(), truth_);
    check_end();
  }

  double true_s_m() {
    s_m_ = world_.line.project(truth_.map_from_vehicle.position(), s_m_).s_m;
    return s_m_;
  }

  void check_end() {
    if (const std::optional<Collision>& collision = observer_.collision()) {
      drive_.collision = collision;
      end(Outcome::collision,
          fmt::format("touched {} at {:.1f} m/s after {:.2f} s, {}", collision->with,
                      truth_.speed_mps, t_s(),
                      collision->is_at_fault ? "at fault" : "the other's fault"));
      drive_.events.push_back({t_s(), EventLevel::fault, drive_.verdict.text});
    } else if (world_.goal) {
      check_timed_goal();
    } else if (truth_.speed_mps <= 0.0) {
      const double missed_m = true_s_m() - world_.line.goal_s_m();
      if (std::abs(missed_m) > options_.goal_tolerance_m) return;
      end(Outcome::goal_reached, fmt::format("goal reached after {:.2f} s, {:.2f} m {} it", t_s(),
                                             std::abs(missed_m), missed_m < 0 ? "before" : "past"));
    }
  }

  /// The goal counts at the scenario's time steps; past it the drive goes on to a stop.
  void check_timed_goal() {
    const planning::TimedGoal& goal = *world_.goal;
    const double step = t_s() / goal.step_s;
    const bool is_step = std::abs(step - std::round(step)) * goal.step_s < 0.5 * kControlStep_s;
    if (is_step && goal.is_reached(world_.road_map, truth_.map_from_vehicle, truth_.speed_mps,
                                   t_s(), scenario_.vehicle)) {
      end(Outcome::goal_reached, fmt::format("goal reached after {:.2f} s", t_s()));
    } else if (truth_.speed_mps <= 0.0 && t_s() > goal.latest_s().value_or(0.0)) {
      end(Outcome::stopped, why_goal_is_missed(goal));
    } else if (is_step) {
      misses_.look(goal, world_.road_map, t_s(), truth_, scenario_.vehicle);
    }
  }

  std::string why_goal_is_missed(const planning::TimedGoal& goal) const {
    if (!goal.latest_s()) {
      return fmt::format("stands after {:.2f} s: the problem states no goal", t_s());
    }
    const std::string best = misses_.at_best();
    return fmt::format("stands after {:.2f} s: the goal was to be reached until {:.2f} s{}{}",
                       t_s(), *goal.latest_s(), best.empty() ? "" : "; ", best);
  }

  void end(Outcome outcome, std::string text) {
    drive_.verdict = {outcome, t_s(), std::move(text)};
    is_over_ = true;
  }

  void finish() {
    record();
    if (!drive_.cycles.empty()) {
      drive_.saturated_ratio =
          static_cast<double>(saturated_) / static_cast<double>(drive_.cycles.size());
    }
    drive_.trajectory = geometry::Trajectory(std::move(rows_));
    if (others_) drive_.tracking = others_->quality();
    take_road(judge_road(world_.road_map, scenario_.vehicle, drive_));
    if (!is_over_) run_out();
    if (options_.predicts || !has_movers()) return;
    drive_.verdict.text += "; the others' future was known";
    if (scenario_.noise.is_of_others()) drive_.verdict.text += ", without their noise";
  }

  bool has_movers() const {
    return std::ranges::any_of(world_.obstacles,
                               [](const planning::Obstacle& other) { return !other.is_static(); });
  }

  void run_out() {
    const double left_m = world_.line.goal_s_m() - true_s_m();
    const bool stands = truth_.speed_mps <= 0.0;
    end(stands ? Outcome::stopped : Outcome::timed_out,
        fmt::format("{} {:.1f} m before the goal after {:.1f} s: {}",
                    stands ? "stands" : "still drives", left_m, t_s(),
                    drive_.cycles.back().reason));
  }

  /// A goal that is reached off the road does not count.
  void take_road(const std::optional<RoadDeparture>& departure) {
    if (!departure) return;
    const std::string off = fmt::format("{:.2f} m off the road", departure->off_m);
    const auto later =
        std::ranges::upper_bound(drive_.events, departure->at_s, {}, &DriveEvent::t_s);
    drive_.events.insert(later, {departure->at_s, EventLevel::fault, off});
    if (drive_.verdict.outcome != Outcome::goal_reached || !is_over_) return;
    drive_.verdict.outcome = Outcome::left_road;
    drive_.verdict.text += fmt::format(", but {} after {:.2f} s", off, departure->at_s);
  }

  void record() {
    rows_.push_back(observer_.row(t_s(), truth_));
    observer_.look(t_s(), truth_);
    const double s_m = true_s_m();
    const control::TrackingError error = tracking_error_of(truth_.map_from_vehicle);
    drive_.samples.push_back({.t_s = t_s(),
                              .s_m = drive_.last_line_from_s_m + s_m,
                              .set_speed_mps = command_.set_speed_mps,
                              .speed_limit_mps = world_.line.corridor_at(s_m).speed_limit_mps,
                              .command_mps2 = command_.acceleration_mps2,
                              .cross_track_m = error.cross_track_m,
                              .heading_error_rad = error.heading_rad,
                              .clearance_m = observer_.take_clearance_m(),
                              .throttle = foot_ ? foot_->pedals().throttle : 0.0,
                              .brake = foot_ ? foot_->pedals().brake : 0.0});
  }

  const Scenario& scenario_;
  World& world_;  ///< its route becomes another one where the road is blocked
  const LoopOptions& options_;
  TrafficFlow flow_;
  Sensors sensors_;
  planning::VehicleState truth_;
  MeasuredCruise cruise_;
  Drive drive_;
  planning::Planner planner_;  ///< of the world, or of what is believed of it
  std::optional<TrackedTraffic> others_;
  GroundTruthMonitor observer_;

  std::optional<PedalModel> foot_;
  std::optional<TrajectoryFollower> follower_;  ///< of what another planner wants
  int steps_ = 0;
  double s_m_ = 0.0;        ///< station on the world's line, when last looked
  double front_s_m_ = 0.0;  ///< station of the front axle's nearest place on the path
  planning::PlannerCommand command_;
  int saturated_ = 0;
  GoalMisses misses_;
  bool is_over_ = false;
  std::vector<geometry::TrajectoryPoint> rows_;
};

}  // namespace

Drive drive(const Scenario& scenario, World& world, const LoopOptions& options) {
  return ClosedLoop(scenario, world, options).run();
}

}  // namespace roadbed::tools::simulation
