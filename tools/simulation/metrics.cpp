#include "roadbed/tools/simulation/metrics.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "roadbed/tools/simulation/comfort.h"
#include "roadbed/tools/simulation/safety_metrics.h"

namespace roadbed::tools::inline simulation {
namespace {

using geometry::TrajectoryPoint;
using nlohmann::ordered_json;

constexpr double kCycle_s = 0.1;

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

ordered_json encounter(const char* key, const std::optional<Encounter>& found) {
  if (!found) return {{std::string(key) + "_s", nullptr}};
  return {{std::string(key) + "_s", found->time_s}, {std::string(key) + "_at_s", found->at_s}};
}

ordered_json encounters(const Scenario& scenario, const World& world, const Drive& drive) {
  ordered_json all =
      encounter("least_time_to_collision", least_time_to_collision(drive, world, scenario.vehicle));
  all.update(encounter("least_headway", least_headway(drive)));
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
    per_behaviour[std::string(name(behaviour)) + "_s"] = kCycle_s * static_cast<double>(cycles);
  }
  return {{"cycles", drive.cycles.size()},
          {"cycles_without_candidate",
           count(drive.cycles, [](const DriveCycle& cycle) { return !cycle.chosen; })},
          {"cycles_from_measurement",
           count(drive.cycles, [](const DriveCycle& cycle) { return cycle.from_measurement; })},
          {"saturated_share", drive.saturated_share},
          {"behaviour", per_behaviour}};
}

std::string_view name(EventLevel level) {
  switch (level) {
    case EventLevel::info:
      return "info";
    case EventLevel::warning:
      return "warning";
    case EventLevel::fault:
      return "fault";
  }
  return "";
}

ordered_json events(const Drive& drive) {
  ordered_json list = ordered_json::array();
  for (const DriveEvent& event : drive.events) {
    list.push_back({{"t_s", event.t_s}, {"level", name(event.level)}, {"text", event.text}});
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
                      {"behaviour", planning::name(cycle.behaviour)},
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
  for (std::size_t i = 1; i < drive.samples.size(); ++i) {
    const bool braked = drive.samples[i - 1].brake > 0.0, brakes = drive.samples[i].brake > 0.0;
    changes += braked != brakes ? 1 : 0;
  }
  return {{"largest_throttle",
           largest(drive.samples, [](const DriveSample& sample) { return sample.throttle; })},
          {"largest_brake",
           largest(drive.samples, [](const DriveSample& sample) { return sample.brake; })},
          {"changes", changes}};
}

ordered_json audit_summary(const std::optional<planning::AuditReport>& audit) {
  if (!audit) return nullptr;
  return {{"verdict", std::string(planning::name(audit->verdict))},
          {"least_clearance_m", audit->least_clearance_m},
          {"least_clearance_at_s", audit->least_clearance_at_s},
          {"beyond_horizon", audit->beyond_horizon},
          {"unknown_share", audit->unknown_share},
          {"conflicts", audit->conflicts.size()}};
}

}  // namespace

ordered_json metrics_of(const Scenario& scenario, const World& world, const Drive& drive,
                        const std::optional<planning::AuditReport>& audit) {
  ordered_json metrics = {
      {"scenario", scenario.name},
      {"seed", scenario.seed},
      {"outcome", std::string(name(drive.verdict.outcome))},
      {"text", drive.verdict.text},
      {"goal_reached", drive.verdict.outcome == Outcome::goal_reached},
      {"collision", drive.verdict.outcome == Outcome::collision},
      {"duration_s", drive.verdict.at_s},
      {"driven_m", driven_m(drive.trajectory)},
      {"to_goal_m", world.line.goal_s_m() - drive.samples.back().s_m},
  };
  for (const ordered_json& part : {least_clearance(drive), encounters(scenario, world, drive),
                                   motion(drive), comfort(drive), tracking(drive), cycles(drive)}) {
    metrics.update(part);
  }
  metrics["pedals"] = pedals(scenario, drive);
  metrics["decisions"] = decisions(drive);
  metrics["events"] = events(drive);
  metrics["audit"] = audit_summary(audit);
  return metrics;
}

}  // namespace roadbed::tools
