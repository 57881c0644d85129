#include "roadbed/tools/simulation/recorded_obstacle.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "roadbed/geometry/primitives/pose2.h"
#include "roadbed/planning/behaviour/shape_bounds.h"
#include "roadbed/planning/behaviour/timed_goal.h"

namespace roadbed::tools::inline simulation {
namespace {

using geometry::Pose2;
using geometry::TrajectoryPoint;
using map::commonroad::Occupancy;
using map::commonroad::State;

constexpr double kAlways_s = std::numeric_limits<double>::infinity();

double middle(const std::optional<map::commonroad::Range<double>>& range) {
  return range ? 0.5 * (range->least + range->most) : 0.0;
}

/// Collects the states of one obstacle, relative to the start.
class Recording {
 public:
  Recording(const map::RoadMap& road_map, long start_step, double step_s)
      : road_map_(road_map), start_step_(start_step), step_s_(step_s) {}

  void add(const State& state, const Eigen::Vector2d& middle_in_shape) {
    const Eigen::Vector2d place =
        state.position_m ? *state.position_m : planning::middle_of(state.region);
    const Pose2 reference{place.x(), place.y(), middle(state.heading_rad)};
    add(state.time_step.least, reference * middle_in_shape, reference.heading_rad,
        middle(state.speed_mps));
  }

  void add(long step, const Eigen::Vector2d& centre_in_source, double heading_rad,
           double speed_mps) {
    const double t_s = step_s_ * static_cast<double>(step - start_step_);
    if (!points_.empty() && t_s <= points_.back().t_s) return;
    const Eigen::Vector2d place = road_map_.to_map(centre_in_source);
    points_.push_back({.t_s = t_s,
                       .x_m = place.x(),
                       .y_m = place.y(),
                       .heading_rad = heading_rad,
                       .speed_mps = speed_mps});
  }

  std::vector<TrajectoryPoint> take() { return std::move(points_); }

 private:
  const map::RoadMap& road_map_;
  long start_step_;
  double step_s_;
  std::vector<TrajectoryPoint> points_;
};

}  // namespace

RecordedObstacle recorded_obstacle(const map::commonroad::Obstacle& from,
                                   const map::RoadMap& road_map, long start_step, double step_s) {
  Eigen::AlignedBox2d box = planning::bounds_of(from.shape);
  Recording recording(road_map, start_step, step_s);
  recording.add(*from.initial_state, box.center());
  for (const State& state : from.trajectory) recording.add(state, box.center());
  Eigen::Vector2d size = box.sizes();
  for (const Occupancy& part : from.occupancy_set) {
    if (part.region.empty()) continue;
    const Eigen::AlignedBox2d area = planning::bounds_of(part.region);
    size = size.cwiseMax(area.sizes());
    recording.add(part.time_step.least, area.center(), 0.0, 0.0);
  }
  RecordedObstacle result{.obstacle = {.id = from.id,
                                       .kind = from.type.empty() ? "car" : from.type,
                                       .length_m = size.x(),
                                       .width_m = size.y(),
                                       .motion = geometry::Trajectory(recording.take())},
                          .presence = {-kAlways_s, kAlways_s}};
  if (!result.obstacle.is_static()) {
    const geometry::Trajectory& motion = result.obstacle.motion;
    result.presence = {motion.start_s() - 1e-6, motion.end_s() + 1e-6};
  }
  return result;
}

}  // namespace roadbed::tools
