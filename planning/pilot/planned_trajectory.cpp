#include "roadbed/planning/pilot/planned_trajectory.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "roadbed/planning/speed/lead.h"

namespace roadbed::planning::inline pilot {
namespace {

constexpr double kStep_s = 0.1;
constexpr double kComfortable_mps2 = 3.0;
constexpr double kHardest_mps2 = geometry::kLongitudinal.max_braking_mps2;
constexpr double kLeast_mps2 = 1.0;    // to a stop that is wanted now
constexpr double kHarder_mps2 = 0.5;   // than foreseen: brake at once
constexpr double kLateral_mps2 = 3.0;  // in bends, on the way to a stop
constexpr double kStandoff_m = 1.0;
constexpr double kWayStep_m = 0.5;

/// Goes on braking at `braking_mps2` to a stop, which is the last state.
void stop_after(std::vector<SpeedState>& drive, double braking_mps2) {
  while (drive.back().speed_mps > 0.0) {
    const SpeedState& last = drive.back();
    const double speed_mps = std::max(0.0, last.speed_mps - kStep_s * braking_mps2);
    drive.push_back({.t_s = last.t_s + kStep_s,
                     .ahead_m = last.ahead_m + 0.5 * kStep_s * (last.speed_mps + speed_mps),
                     .speed_mps = speed_mps,
                     .acceleration_mps2 = speed_mps > 0.0 ? -braking_mps2 : 0.0,
                     .command_mps2 = -braking_mps2});
  }
}

std::vector<SpeedState> stop_from(double speed_mps, double braking_mps2) {
  const double now_mps2 = speed_mps > 0.0 ? -braking_mps2 : 0.0;
  std::vector<SpeedState> drive{{.speed_mps = speed_mps, .acceleration_mps2 = now_mps2}};
  stop_after(drive, braking_mps2);
  return drive;
}

/// Between two states, on the cubic through their places and speeds.
SpeedState between(const SpeedState& a, const SpeedState& b, double t_s) {
  const double over_s = b.t_s - a.t_s, f = (t_s - a.t_s) / over_s, way_m = b.ahead_m - a.ahead_m;
  const double bend_m = over_s * a.speed_mps - way_m, turn_m = way_m - over_s * b.speed_mps;
  const double aside_m = f * (1.0 - f) * ((1.0 - f) * bend_m + f * turn_m);
  const auto mixed = [f](double from, double to) { return from + f * (to - from); };
  return {.t_s = t_s,
          .ahead_m = mixed(a.ahead_m, b.ahead_m) + aside_m,
          .speed_mps = mixed(a.speed_mps, b.speed_mps),
          .acceleration_mps2 = mixed(a.acceleration_mps2, b.acceleration_mps2),
          .command_mps2 = b.command_mps2};
}

/// A state every 0.1 s: a drive that was searched for has them farther apart.
std::vector<SpeedState> in_steps(const std::vector<SpeedState>& drive) {
  constexpr double kRounding_s = 1e-9;
  std::vector<SpeedState> steps{drive.front()};
  for (std::size_t i = 1; i < drive.size(); ++i) {
    const SpeedState& next = drive[i];
    while (steps.back().t_s + kStep_s < next.t_s - kRounding_s) {
      steps.push_back(between(drive[i - 1], next, steps.back().t_s + kStep_s));
    }
    steps.push_back(next);
  }
  return steps;
}

double needed_mps2(const SpeedState& from, double room_m) {
  return emergency_stop_mps2(from.speed_mps, room_m - from.ahead_m).value_or(0.0);
}

double stopping_m(double speed_mps, double braking_mps2) {
  return 0.5 * speed_mps * speed_mps / braking_mps2;
}

/// Gives up what of a drive leads too far to stop in time, comfortably if that can be done.
void cut_before(std::vector<SpeedState>& drive, double room_m) {
  while (drive.size() > 1 && needed_mps2(drive.back(), room_m) > kComfortable_mps2) {
    drive.pop_back();
  }
}

double way_to_m(const PlannedPath& path, double s_m, double to_s_m) {
  constexpr double kFar_m = 1000.0;
  if (to_s_m > s_m + kFar_m) return std::numeric_limits<double>::infinity();
  double way_m = 0.0;
  for (; s_m < to_s_m; s_m += kWayStep_m) {
    way_m += std::min(kWayStep_m, to_s_m - s_m) * path.place_at(s_m).stretch;
  }
  return way_m;
}

/// Station after `way_m` of the path.
double station_after(const PlannedPath& path, double s_m, double way_m) {
  while (way_m > 0.0) {
    const double step_m = std::min(kWayStep_m, way_m);
    s_m += step_m / std::max(0.1, path.place_at(s_m).stretch);
    way_m -= step_m;
  }
  return s_m;
}

/// Places of a drive's states on the way.
std::vector<PlannedPath::Place> places_of(const WayToDrive& way,
                                          const std::vector<SpeedState>& drive) {
  std::vector<PlannedPath::Place> places;
  double s_m = way.from_s_m, ahead_m = 0.0;
  for (const SpeedState& state : drive) {
    s_m = station_after(way.path, s_m, state.ahead_m - ahead_m);
    ahead_m = std::max(ahead_m, state.ahead_m);
    places.push_back(way.path.place_at(s_m));
  }
  return places;
}

/// Most that a drive asks to the side.
double most_lateral_mps2(const WayToDrive& way, const std::vector<SpeedState>& drive) {
  const std::vector<PlannedPath::Place> places = places_of(way, drive);
  double most_mps2 = 0.0;
  for (std::size_t i = 0; i < drive.size(); ++i) {
    const double speed_mps = drive[i].speed_mps;
    most_mps2 = std::max(most_mps2, std::abs(places[i].curvature_per_m) * speed_mps * speed_mps);
  }
  return most_mps2;
}

/// As softly as may be, but for the bends on the way.
std::vector<SpeedState> stop_along(const WayToDrive& way, double speed_mps, double least_mps2) {
  std::vector<SpeedState> drive = stop_from(speed_mps, least_mps2);
  const double bend_per_m = std::abs(way.path.curvature_per_m(way.from_s_m));
  const double allowed_mps2 = std::max(kLateral_mps2, bend_per_m * speed_mps * speed_mps);
  for (double braking_mps2 = least_mps2 + kHarder_mps2;
       braking_mps2 <= kHardest_mps2 && most_lateral_mps2(way, drive) > allowed_mps2;
       braking_mps2 += kHarder_mps2) {
    drive = stop_from(speed_mps, braking_mps2);
  }
  return drive;
}

std::vector<SpeedState> whole_drive(const WayToDrive& way, const VehicleState& measured,
                                    const PlannerCommand& decision, double room_m) {
  const double wanted_mps2 = decision.acceleration_mps2;
  const std::vector<SpeedState>& foreseen = decision.drive;
  const double foreseen_mps2 = foreseen.size() > 1 ? foreseen[1].acceleration_mps2 : 0.0;
  const auto stop_now = [&](double least_mps2) {
    const double needed = needed_mps2({.speed_mps = measured.speed_mps}, room_m);
    return stop_along(way, measured.speed_mps, std::max(needed, least_mps2));
  };
  if (wanted_mps2 < std::min(0.0, foreseen_mps2) - kHarder_mps2) return stop_now(-wanted_mps2);
  if (decision.set_speed_mps <= 0.0) {  // what was foreseen is of a path that is given up
    return stop_now(std::max(kLeast_mps2, -wanted_mps2));
  }
  std::vector<SpeedState> drive = in_steps(foreseen);
  const double after_mps2 = braking_after_mps2(foreseen, decision.lead);
  cut_before(drive, room_m);
  stop_after(drive, std::max(needed_mps2(drive.back(), room_m), after_mps2));
  return drive;
}

}  // namespace

double braking_after_mps2(const std::vector<SpeedState>& drive,
                          const std::optional<DriveLead>& lead) {
  if (!lead || drive.empty()) return kComfortable_mps2;
  const SpeedState& end = drive.back();
  const double lead_mps = std::max(0.0, lead->speed_mps);
  const double left_m = lead->gap_m + lead_mps * end.t_s - end.ahead_m - kStandoff_m +
                        lead_mps * lead_mps / (2.0 * kHardest_mps2);
  const double needed_mps2 =
      left_m > 0.0 ? end.speed_mps * end.speed_mps / (2.0 * left_m) : kHardest_mps2;
  return std::clamp(needed_mps2, kComfortable_mps2, kHardest_mps2);
}

double farthest_m(const PlannerCommand& decision) {
  const SpeedState &now = decision.drive.front(), &end = decision.drive.back();
  const double braking_mps2 = std::max(kHarder_mps2, -decision.acceleration_mps2);
  return std::max(end.ahead_m + stopping_m(end.speed_mps, kComfortable_mps2),
                  stopping_m(now.speed_mps, braking_mps2));
}

geometry::Trajectory planned_trajectory(const WayToDrive& way, double t_s,
                                        const VehicleState& measured,
                                        const PlannerCommand& decision,
                                        const geometry::VehicleShape& vehicle) {
  const double room_m = way_to_m(way.path, way.from_s_m, way.to_s_m);
  const std::vector<SpeedState> drive = whole_drive(way, measured, decision, room_m);
  const std::vector<PlannedPath::Place> places = places_of(way, drive);
  std::vector<geometry::TrajectoryPoint> rows;
  for (std::size_t i = 0; i < drive.size(); ++i) {
    const SpeedState& state = drive[i];
    const PlannedPath::Place& place = places[i];
    rows.push_back({.t_s = t_s + state.t_s,
                    .x_m = place.pose.x_m,
                    .y_m = place.pose.y_m,
                    .heading_rad = place.pose.heading_rad,
                    .speed_mps = state.speed_mps,
                    .acceleration_mps2 = state.acceleration_mps2,
                    .steering_rad = std::atan(vehicle.wheelbase_m * place.curvature_per_m),
                    .curvature_per_m = place.curvature_per_m});
  }
  return geometry::Trajectory(std::move(rows));
}

geometry::Trajectory stopping_trajectory(double t_s, const VehicleState& measured) {
  std::vector<geometry::TrajectoryPoint> rows;
  for (const SpeedState& state : stop_from(measured.speed_mps, kComfortable_mps2)) {
    const geometry::Pose2 pose =
        measured.map_from_vehicle * geometry::Pose2{state.ahead_m, 0.0, 0.0};
    rows.push_back({.t_s = t_s + state.t_s,
                    .x_m = pose.x_m,
                    .y_m = pose.y_m,
                    .heading_rad = pose.heading_rad,
                    .speed_mps = state.speed_mps,
                    .acceleration_mps2 = state.acceleration_mps2});
  }
  return geometry::Trajectory(std::move(rows));
}

}  // namespace roadbed::planning::pilot
