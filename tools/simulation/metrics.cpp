#include "roadbed/tools/simulation/metrics.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "roadbed/geometry/motion/longitudinal.h"
#include "roadbed/geometry/motion/rectangle.h"
#include "roadbed/planning/speed/lead.h"

namespace roadbed::tools::inline simulation {
namespace {

using geometry::TrajectoryPoint;
using nlohmann::ordered_json;

constexpr double kCycle_s = geometry::kLongitudinal.cycle_s;

/// Largest value of a function over a list; 0 for an empty one.
template <typename List, typename Value>
double largest(const List& list, Value value) {
  double most = 0.0;
  for (const auto& element : list) most = std::max(most, static_cast<double>(value(element)));
  return most;
}

template <typename List, typename Test>
std::size_t count(const List& list, Test test) {
  return static_cast<std::size_t>(std::count_if(list.begin(), list.end(), test));
}

double driven_m(const geometry::Trajectory& drive) {
  double length = 0.0;
  const auto& rows = drive.points();
  for (std::size_t i = 1; i < rows.size(); ++i) {
    length += (rows[i].pose().position() - rows[i - 1].pose().position()).norm();
  }
  return length;
}

double cross_track_rms_m(const Drive& drive) {
  double sum = 0.0;
  for (const DriveSample& sample : drive.samples)
    sum += sample.cross_track_m * sample.cross_track_m;
  return std::sqrt(sum / static_cast<double>(drive.samples.size()));
}

ordered_json least_clearance(const Drive& drive) {
  const auto nearest = std::min_element(
      drive.samples.begin(), drive.samples.end(),
      [](const DriveSample& a, const DriveSample& b) { return a.clearance_m < b.clearance_m; });
  if (!std::isfinite(nearest->clearance_m)) return {{"least_clearance_m", nullptr}};
  return {{"least_clearance_m", nearest->clearance_m}, {"least_clearance_at_s", nearest->t_s}};
}

/// ∫ max(0, v − limit) dt over the rows.
double over_speed_m(const Drive& drive) {
  double sum = 0.0;
  for (const DriveSample& sample : drive.samples) {
    sum += kCycle_s *
           std::max(0.0, drive.trajectory.at(sample.t_s).speed_mps - sample.speed_limit_mps);
  }
  return sum;
}

ordered_json motion(const Drive& drive) {
  const auto& rows = drive.trajectory.points();
  return {{"largest_speed_mps", largest(rows, [](const auto& row) { return row.speed_mps; })},
          {"largest_over_speed_mps", largest(drive.samples,
                                             [&](const DriveSample& sample) {
                                               return drive.trajectory.at(sample.t_s).speed_mps -
                                                      sample.speed_limit_mps;
                                             })},
          {"over_speed_m", over_speed_m(drive)},
          {"largest_acceleration_mps2",
           largest(rows, [](const auto& row) { return row.acceleration_mps2; })},
          {"largest_deceleration_mps2",
           largest(rows, [](const auto& row) { return -row.acceleration_mps2; })},
          {"largest_lateral_acceleration_mps2", largest(rows, [](const TrajectoryPoint& row) {
             return std::abs(row.curvature_per_m) * row.speed_mps * row.speed_mps;
           })}};
}

ordered_json comfort(const Drive& drive) {
  const Comfort found = comfort_of(drive.trajectory);
  return {{"comfort",
           {{"least_longitudinal_mps2", found.least_longitudinal_mps2},
            {"most_longitudinal_mps2", found.most_longitudinal_mps2},
            {"most_lateral_mps2", found.most_lateral_mps2},
            {"most_yaw_acceleration_radps2", found.most_yaw_acceleration_radps2},
            {"most_yaw_rate_radps", found.most_yaw_rate_radps},
            {"most_longitudinal_jerk_mps3", found.most_longitudinal_jerk_mps3},
            {"most_jerk_mps3", found.most_jerk_mps3},
            {"is_comfortable", found.is_comfortable()}}}};
}

ordered_json safety_metric(const char* key, const std::optional<SafetyMetric>& found) {
  if (!found) return {{std::string(key) + "_s", nullptr}};
  return {{std::string(key) + "_s", found->time_s}, {std::string(key) + "_at_s", found->at_s}};
}

ordered_json safety_metrics(const Scenario& scenario, const World& world, const Drive& drive) {
  ordered_json all = safety_metric("least_time_to_collision",
                                   least_time_to_collision(drive, world, scenario.vehicle));
  all.update(safety_metric("least_headway", least_headway(drive)));
  all["wrong_way_m"] = wrong_way_m(drive);
  all["progress_m"] = drive.samples.back().s_m - drive.samples.front().s_m;
  return all;
}

ordered_json tracking(const Drive& drive) {
  return {{"largest_cross_track_m",
           largest(drive.samples,
                   [](const DriveSample& sample) { return std::abs(sample.cross_track_m); })},
          {"cross_track_rms_m", cross_track_rms_m(drive)},
          {"largest_heading_error_rad",
           largest(drive.samples,
                   [](const DriveSample& sample) { return std::abs(sample.heading_error_rad); })},
          {"largest_off_road_m",
           largest(drive.samples, [](const DriveSample& sample) { return sample.off_road_m; })}};
}

ordered_json cycles(const Drive& drive) {
  ordered_json per_behaviour = ordered_json::object();
  for (const planning::Behaviour behaviour :
       {planning::Behaviour::cruise, planning::Behaviour::pass, planning::Behaviour::follow,
        planning::Behaviour::yield, planning::Behaviour::stop, planning::Behaviour::emergency}) {
    const std::size_t cycles =
        count(drive.cycles, [&](const DriveCycle& cycle) { return cycle.behaviour == behaviour; });
    per_behaviour[std::string(to_string(behaviour)) + "_s"] =
        kCycle_s * static_cast<double>(cycles);
  }
  return {{"cycles", drive.cycles.size()},
          {"cycles_without_candidate",
           count(drive.cycles, [](const DriveCycle& cycle) { return !cycle.has_plan(); })},
          {"cycles_from_measurement",
           count(drive.cycles, [](const DriveCycle& cycle) { return cycle.from_measurement; })},
          {"saturated_share", drive.saturated_ratio},
          {"behaviour", per_behaviour}};
}

ordered_json events(const Drive& drive) {
  ordered_json list = ordered_json::array();
  for (const DriveEvent& event : drive.events) {
    list.push_back({{"t_s", event.t_s}, {"level", to_string(event.level)}, {"text", event.text}});
  }
  return list;
}

/// Where the behaviour changes, with the reason at that time.
ordered_json decisions(const Drive& drive) {
  ordered_json list = ordered_json::array();
  const DriveCycle* last = nullptr;
  for (const DriveCycle& cycle : drive.cycles) {
    if (!last || last->behaviour != cycle.behaviour) {
      list.push_back({{"t_s", cycle.t_s},
                      {"behaviour", planning::to_string(cycle.behaviour)},
                      {"reason", cycle.reason}});
    }
    last = &cycle;
  }
  return list;
}

/// How the pedals were used; null without any.
ordered_json pedals(const Scenario& scenario, const Drive& drive) {
  if (!scenario.pedals) return nullptr;
  int changes = 0;
  std::optional<bool> braked;
  for (const DriveSample& sample : drive.samples) {
    if (sample.brake <= 0.0 && sample.throttle <= 0.0) continue;
    const bool brakes = sample.brake > 0.0;
    changes += braked && *braked != brakes ? 1 : 0;
    braked = brakes;
  }
  return {{"largest_throttle",
           largest(drive.samples, [](const DriveSample& sample) { return sample.throttle; })},
          {"largest_brake",
           largest(drive.samples, [](const DriveSample& sample) { return sample.brake; })},
          {"changes", changes}};
}

/// Null without a collision.
ordered_json collision_kind(const Drive& drive) {
  if (!drive.collision) return nullptr;
  return to_string(drive.collision->kind);
}

/// Null where the future is known.
ordered_json knowledge_of_others(const std::optional<TrackingQuality>& tracking) {
  if (!tracking) return nullptr;
  const auto root_of_mean = [&](double sum_m2) -> ordered_json {
    if (tracking->measurements == 0) return nullptr;
    return std::sqrt(sum_m2 / static_cast<double>(tracking->measurements));
  };
  return {{"measurements", tracking->measurements},
          {"measured_rms_m", root_of_mean(tracking->measured_m2)},
          {"tracked_rms_m", root_of_mean(tracking->tracked_m2)},
          {"identity_swaps", tracking->identity_swaps}};
}

ordered_json audit_summary(const std::optional<planning::AuditReport>& audit) {
  if (!audit) return nullptr;
  return {{"verdict", std::string(planning::to_string(audit->verdict))},
          {"least_clearance_m", audit->least_clearance_m},
          {"least_clearance_at_s", audit->least_clearance_at_s},
          {"beyond_horizon", audit->beyond_horizon},
          {"unknown_share", audit->unknown_fraction},
          {"conflicts", audit->conflicts.size()}};
}

using geometry::Rectangle;

constexpr double kLook_s = 3.0, kLookStep_s = 0.1;
constexpr double kLeastSpeed_mps = 1.0;

Rectangle moved(Rectangle body, const Eigen::Vector2d& velocity_mps, double duration_s) {
  body.centre += duration_s * velocity_mps;
  return body;
}

Eigen::Vector2d velocity_of(const planning::Obstacle& obstacle, double t_s) {
  if (obstacle.is_static()) return {0.0, 0.0};
  const geometry::TrajectoryPoint at = obstacle.motion.at(t_s);
  return at.speed_mps * Eigen::Vector2d(std::cos(at.heading_rad), std::sin(at.heading_rad));
}

/// First time at which two bodies touch, less than `within_s`.
std::optional<double> time_to_touch(const Rectangle& a, const Eigen::Vector2d& velocity_a,
                                    const Rectangle& b, const Eigen::Vector2d& velocity_b,
                                    double within_s) {
  const double reach = a.radius_m() + b.radius_m() + (velocity_b - velocity_a).norm() * within_s;
  if ((a.centre - b.centre).norm() > reach) return std::nullopt;
  const auto steps = static_cast<int>(std::lround(within_s / kLookStep_s));
  for (int k = 0; k < steps; ++k) {
    const double ahead_s = kLookStep_s * k;
    if (geometry::distance_m(moved(a, velocity_a, ahead_s), moved(b, velocity_b, ahead_s)) <= 0.0)
      return ahead_s;
  }
  return std::nullopt;
}

}  // namespace

ordered_json metrics_of(const Scenario& scenario, const World& world, const Drive& drive,
                        const std::optional<planning::AuditReport>& audit) {
  ordered_json metrics = {
      {"roadbed_metrics", 1},
      {"scenario", scenario.name},
      {"seed", scenario.seed},
      {"outcome", std::string(to_string(drive.verdict.outcome))},
      {"text", drive.verdict.text},
      {"goal_reached", drive.verdict.outcome == Outcome::goal_reached},
      {"collision", drive.verdict.outcome == Outcome::collision},
      {"collision_kind", collision_kind(drive)},
      {"at_fault", drive.collision && drive.collision->is_at_fault},
      {"duration_s", drive.verdict.at_s},
      {"driven_m", driven_m(drive.trajectory)},
      {"to_goal_m", drive.last_line_from_s_m + world.line.goal_s_m() - drive.samples.back().s_m},
  };
  for (const ordered_json& part : {least_clearance(drive), safety_metrics(scenario, world, drive),
                                   motion(drive), comfort(drive), tracking(drive), cycles(drive)}) {
    metrics.update(part);
  }
  metrics["others"] = knowledge_of_others(drive.tracking);
  metrics["pedals"] = pedals(scenario, drive);
  metrics["decisions"] = decisions(drive);
  metrics["events"] = events(drive);
  metrics["audit"] = audit_summary(audit);
  return metrics;
}

std::optional<SafetyMetric> least_time_to_collision(const Drive& drive, const World& world,
                                                    const geometry::VehicleShape& vehicle) {
  std::optional<SafetyMetric> least;
  double within_s = kLook_s + kLookStep_s;
  for (const geometry::TrajectoryPoint& row : drive.trajectory.points()) {
    const Eigen::Vector2d in_map = world.road_map.to_map({row.x_m, row.y_m});
    const Rectangle body = geometry::body_at({in_map.x(), in_map.y(), row.heading_rad}, vehicle);
    const Eigen::Vector2d velocity = row.speed_mps * body.axis;
    for (std::size_t i = 0; i < world.obstacles.size(); ++i) {
      if (!world.obstacles[i].is_there(row.t_s)) continue;
      const auto touch = time_to_touch(body, velocity, rectangle_at(world.obstacles[i], row.t_s),
                                       velocity_of(world.obstacles[i], row.t_s), within_s);
      if (!touch) continue;
      least = SafetyMetric{*touch, row.t_s};
      within_s = *touch;
    }
  }
  return least;
}

std::optional<SafetyMetric> least_headway(const Drive& drive) {
  std::optional<SafetyMetric> least;
  for (const DriveCycle& cycle : drive.cycles) {
    const double speed = drive.trajectory.at(cycle.t_s).speed_mps;
    if (!cycle.lead || speed < kLeastSpeed_mps) continue;
    const double headway_s = cycle.lead->gap_m / speed;
    if (!least || headway_s < least->time_s) least = SafetyMetric{headway_s, cycle.t_s};
  }
  return least;
}

double wrong_way_m(const Drive& drive) {
  double back_m = 0.0;
  for (std::size_t i = 1; i < drive.samples.size(); ++i) {
    back_m += std::max(0.0, drive.samples[i - 1].s_m - drive.samples[i].s_m);
  }
  return back_m;
}

}  // namespace roadbed::tools::simulation
