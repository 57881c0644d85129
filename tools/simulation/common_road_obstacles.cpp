#include "roadbed/tools/simulation/common_road_obstacles.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>
#include <string>

#include "roadbed/geometry/motion/rectangle.h"
#include "roadbed/geometry/primitives/angle.h"
#include "roadbed/map/files/input_error.h"
#include "roadbed/planning/obstacles/obstacle_limits.h"
#include "roadbed/planning/obstacles/recorded_obstacles.h"
#include "roadbed/planning/speed/lead.h"

namespace roadbed::tools::inline simulation {
namespace {

constexpr double kSamePlace_m = 0.1, kSameHeading_rad = 0.1, kSameExtent_m = 0.5;

/// A recording is one state for each time step: where one is missing nobody knows where it was.
void refuse_gaps(const std::string& file, const map::commonroad::Obstacle& obstacle) {
  long last = obstacle.initial_state->time_step.least;
  for (const map::commonroad::State& state : obstacle.trajectory) {
    const long step = state.time_step.least;
    if (step != last + 1) {
      throw map::InputError({.file = file,
                             .element = "obstacle " + obstacle.id,
                             .found = fmt::format("time step {} after {}", step, last),
                             .needed = "a state for each time step",
                             .remedy = "add what is missing, or cut the trajectory off before"});
    }
    last = step;
  }
}

/// Occupancies are areas in order of time.
void refuse_occupancies(const std::string& file, const map::commonroad::Obstacle& obstacle) {
  long last = std::numeric_limits<long>::min();
  for (const map::commonroad::Occupancy& part : obstacle.occupancy_set) {
    const long step = part.time_step.least;
    if (!part.region.empty() && step > last) {
      last = part.time_step.most;
      continue;
    }
    throw map::InputError(
        {.file = file,
         .element = "obstacle " + obstacle.id,
         .found = part.region.empty()
                      ? fmt::format("an occupancy at time step {} without a shape", step)
                      : fmt::format("an occupancy at time step {} after {}", step, last),
         .needed = "a shape for each, in order of time",
         .remedy = "correct the occupancy set"});
  }
}

double apart_m(const geometry::Rectangle& a, const geometry::Rectangle& b) {
  return (a.centre - b.centre).norm();
}

bool is_ego_recording(const geometry::Rectangle& body, const geometry::Rectangle& other) {
  const double turn = std::acos(std::clamp(body.axis.dot(other.axis), -1.0, 1.0));
  return apart_m(body, other) <= kSamePlace_m && turn <= kSameHeading_rad &&
         2.0 * std::abs(body.half_length_m - other.half_length_m) <= kSameExtent_m &&
         2.0 * std::abs(body.half_width_m - other.half_width_m) <= kSameExtent_m;
}

[[noreturn]] void refuse_overlap(const ProblemSource& source, const std::string& id,
                                 const geometry::Rectangle& body,
                                 const geometry::Rectangle& other) {
  if (!is_ego_recording(body, other)) {
    source.refuse(fmt::format("obstacle {} touches the ego at the start", id), "room to start from",
                  "move one of the two");
  }
  source.refuse(
      fmt::format("obstacle {} is {:.1f} m from the ego at the start and of its extent: the ego's "
                  "own recording",
                  id, apart_m(body, other)),
      "room to start from", "leave it out with --drop-ego-recording");
}

}  // namespace

std::vector<planning::Obstacle> obstacles_of(const map::commonroad::Scenario& from,
                                             const ProblemSource& source,
                                             const geometry::Pose2& start,
                                             const geometry::VehicleShape& vehicle,
                                             bool drops_ego_recording) {
  const planning::RecordingClock clock{source.problem.initial_state.time_step.least,
                                       from.time_step_s};
  const geometry::Rectangle body = geometry::body_at(start, vehicle);
  std::vector<planning::Obstacle> obstacles;
  for (const map::commonroad::Obstacle& recorded : from.obstacles) {
    if (recorded.role != map::commonroad::ObstacleRole::fixed &&
        recorded.role != map::commonroad::ObstacleRole::dynamic) {
      continue;
    }
    refuse_gaps(source.file, recorded);
    refuse_occupancies(source.file, recorded);
    std::vector<planning::Obstacle> pieces;
    bool is_dropped = false;
    for (const planning::ObstacleInSource& piece : planning::recorded_obstacles(recorded, clock)) {
      pieces.push_back(planning::obstacle_in_map(source.road_map, piece));
      if (!pieces.back().is_there(0.0)) continue;
      const geometry::Rectangle other = rectangle_at(pieces.back(), 0.0);
      if (geometry::distance_m(body, other) > 0.0) continue;
      is_dropped = drops_ego_recording && is_ego_recording(body, other);
      if (!is_dropped) refuse_overlap(source, recorded.id, body, other);
    }
    if (!is_dropped) obstacles.insert(obstacles.end(), pieces.begin(), pieces.end());
  }
  planning::refuse_endless_ways(std::span<const planning::Obstacle>(obstacles), source.file);
  return obstacles;
}

}  // namespace roadbed::tools::simulation
