#include "roadbed/tools/audit/recorded_boxes.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <cmath>
#include <cstddef>
#include <limits>
#include <utility>
#include <variant>

#include "roadbed/geometry/primitives/pose2.h"
#include "roadbed/map/files/input_error.h"
#include "roadbed/planning/behaviour/shape_bounds.h"

namespace roadbed::tools::inline audit {
namespace {

using geometry::Pose2;
using geometry::TrajectoryPoint;
using map::commonroad::Obstacle;
using map::commonroad::ObstacleRole;
using map::commonroad::PolygonShape;
using map::commonroad::RectangleShape;
using map::commonroad::Shape;
using map::commonroad::State;
using planning::MovingObstacle;

constexpr double kForEver_s = std::numeric_limits<double>::infinity();
constexpr double kMoment_s = 1e-6;  // times of a drive and of a recording are rounded differently

struct StandingBox {
  Pose2 centre;
  double length_m, width_m;
};

// The rectangle along a direction that just holds all corners.
StandingBox box_along(const Eigen::Vector2d& ahead, const geometry::Ring& corners) {
  const Eigen::Vector2d left(-ahead.y(), ahead.x());
  Eigen::AlignedBox2d box;
  for (const Eigen::Vector2d& corner : corners) {
    box.extend(Eigen::Vector2d(corner.dot(ahead), corner.dot(left)));
  }
  const Eigen::Vector2d middle = box.center().x() * ahead + box.center().y() * left;
  return {
      {middle.x(), middle.y(), std::atan2(ahead.y(), ahead.x())}, box.sizes().x(), box.sizes().y()};
}

// The least rectangle around a convex polygon has a side along one of its edges [Freeman & Shapira
// 1975, doi:10.1145/360881.360919]; around another it is at least no larger than the one along x.
StandingBox tightest_box(const geometry::Ring& corners) {
  StandingBox best = box_along({1.0, 0.0}, corners);
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const Eigen::Vector2d edge = corners[(i + 1) % corners.size()] - corners[i];
    constexpr double shortest_m = 1e-3;
    if (edge.norm() < shortest_m) continue;
    const StandingBox box = box_along(edge.normalized(), corners);
    constexpr double less = 1.0 - 1e-9;  // whatever the rounding
    if (box.length_m * box.width_m < less * best.length_m * best.width_m) best = box;
  }
  return best;
}

StandingBox box_of(const Shape::value_type& part) {
  if (const auto* polygon = std::get_if<PolygonShape>(&part)) {
    return tightest_box(polygon->corners_m);
  }
  if (const auto* rectangle = std::get_if<RectangleShape>(&part)) {
    const Eigen::Vector2d& centre = rectangle->centre_m;
    return {
        {centre.x(), centre.y(), rectangle->heading_rad}, rectangle->length_m, rectangle->width_m};
  }
  const Eigen::AlignedBox2d around = planning::bounds_of(Shape(1, part));
  const Eigen::Vector2d centre = around.center(), size = around.sizes();
  return {{centre.x(), centre.y(), 0.0}, size.x(), size.y()};
}

/// Of one obstacle.
class RecordedBoxes {
 public:
  RecordedBoxes(const map::commonroad::Scenario& scenario, const std::string& file,
                const Obstacle& from)
      : file_(file), from_(from), step_s_(scenario.time_step_s) {
    if (!scenario.planning_problems.empty()) {
      start_step_ = scenario.planning_problems.front().initial_state.time_step.least;
    }
  }

  std::vector<MovingObstacle> take() {
    check_parts();
    if (from_.role == ObstacleRole::environment) {
      add_standing(from_.shape, -kForEver_s, kForEver_s);
    } else if (from_.initial_state) {
      add_states();
    }
    for (const auto& part : from_.occupancy_set) {
      if (part.region.empty()) {
        refuse(fmt::format("an occupancy at time step {} without a shape", part.time_step.least),
               "a rectangle, circle or polygon");
      }
      add_standing(part.region, seconds(part.time_step.least), seconds(part.time_step.most + 1));
    }
    if (boxes_.empty()) {
      refuse("nothing says where it is", "a shape with an initial state, or an occupancy set");
    }
    set_ids();
    return std::move(boxes_);
  }

 private:
  [[noreturn]] void refuse(const std::string& found, const std::string& needed) const {
    throw map::InputError({.file = file_,
                           .place = {},
                           .element = "obstacle " + from_.id,
                           .found = found,
                           .needed = needed,
                           .remedy = "correct the obstacle, or remove it"});
  }

  void check_parts() const {
    const bool has_states = from_.role != ObstacleRole::environment && from_.initial_state;
    if (has_states && from_.shape.empty()) refuse("a state without a shape", "both");
    if (!has_states && !from_.trajectory.empty()) {
      refuse("a trajectory without an initial state", "both");
    }
    const bool moves = !from_.trajectory.empty() || !from_.occupancy_set.empty();
    if (from_.role == ObstacleRole::fixed && moves) {
      refuse("it is static, and has a prediction", "one of the two");
    }
  }

  double seconds(long step) const { return step_s_ * static_cast<double>(step - start_step_); }

  void add(std::vector<TrajectoryPoint> rows, double length_m, double width_m, double from_s,
           double to_s) {
    boxes_.push_back({.obstacle = {.id = from_.id,
                                   .kind = from_.type,
                                   .length_m = length_m,
                                   .width_m = width_m,
                                   .motion = geometry::Trajectory(std::move(rows))},
                      .from_s = from_s - kMoment_s,
                      .to_s = to_s + kMoment_s});
  }

  void add_standing(const Shape& shape, double from_s, double to_s) {
    for (const auto& part : shape) {
      const StandingBox box = box_of(part);
      const Pose2& at = box.centre;
      add({{.x_m = at.x_m, .y_m = at.y_m, .heading_rad = at.heading_rad}}, box.length_m,
          box.width_m, from_s, to_s);
    }
  }

  void add_states() {
    const Eigen::AlignedBox2d shape = planning::bounds_of(from_.shape);
    std::vector<TrajectoryPoint> rows{row_of(*from_.initial_state, shape.center())};
    for (const State& state : from_.trajectory) {
      const TrajectoryPoint row = row_of(state, shape.center());
      if (!(row.t_s > rows.back().t_s)) {
        refuse(fmt::format("the state of time step {} does not follow the one before",
                           state.time_step.least),
               "states in order of time");
      }
      rows.push_back(row);
    }
    double from_s = -kForEver_s, to_s = kForEver_s;
    if (!from_.trajectory.empty()) {
      from_s = rows.front().t_s;
      to_s = rows.back().t_s;
    } else if (!from_.occupancy_set.empty()) {
      from_s = rows.front().t_s;
      to_s = seconds(from_.initial_state->time_step.least + 1);
    }
    add(std::move(rows), shape.sizes().x(), shape.sizes().y(), from_s, to_s);
  }

  TrajectoryPoint row_of(const State& state, const Eigen::Vector2d& middle_in_shape) const {
    const auto check = [&](bool is_exact, const char* what, const char* needed) {
      if (is_exact) return;
      refuse(
          fmt::format("{} of the state at time step {} is not exact", what, state.time_step.least),
          needed);
    };
    check(state.time_step.is_exact(), "the time", "one time step");
    check(state.position_m && state.region.empty() && state.lanelets.empty(), "the position",
          "one point, or an occupancy set in place of the states");
    check(state.heading_rad && state.heading_rad->is_exact(), "the orientation",
          "one number, or an occupancy set in place of the states");
    const Pose2 reference{state.position_m->x(), state.position_m->y(), state.heading_rad->least};
    const Eigen::Vector2d centre = reference * middle_in_shape;
    return {.t_s = seconds(state.time_step.least),
            .x_m = centre.x(),
            .y_m = centre.y(),
            .heading_rad = reference.heading_rad};
  }

  void set_ids() {
    if (boxes_.size() == 1) return;
    for (std::size_t i = 0; i < boxes_.size(); ++i) {
      boxes_[i].obstacle.id += fmt::format(".{}", i + 1);
    }
  }

  const std::string& file_;
  const Obstacle& from_;
  double step_s_;
  long start_step_ = 0;
  std::vector<MovingObstacle> boxes_;
};

}  // namespace

std::vector<MovingObstacle> recorded_boxes(const map::commonroad::Scenario& scenario,
                                           const std::string& name) {
  std::vector<MovingObstacle> boxes;
  for (const Obstacle& obstacle : scenario.obstacles) {
    for (MovingObstacle& box : RecordedBoxes(scenario, name, obstacle).take()) {
      boxes.push_back(std::move(box));
    }
  }
  return boxes;
}

}  // namespace roadbed::tools
