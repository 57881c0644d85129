#include "roadbed/planning/obstacles/recorded_obstacles.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <optional>
#include <utility>
#include <variant>

#include "roadbed/geometry/primitives/pose2.h"
#include "roadbed/map/files/input_error.h"

namespace roadbed::planning::inline obstacles {
namespace {

using geometry::Pose2;
using geometry::TrajectoryPoint;
using map::commonroad::ObstacleRole;
using map::commonroad::Occupancy;
using map::commonroad::PolygonShape;
using map::commonroad::RectangleShape;
using map::commonroad::Shape;
using map::commonroad::State;

using Recorded = map::commonroad::Obstacle;

double mean_of(const std::optional<map::commonroad::Range<double>>& range) {
  return range ? 0.5 * (range->least + range->most) : 0.0;
}

// Of its shape's middle; the middles of regions and intervals stand for what is not exact.
TrajectoryPoint point_of(const State& state, const Eigen::Vector2d& middle_in_shape,
                         const RecordingClock& clock) {
  const Eigen::Vector2d place =
      state.position_m ? *state.position_m : Eigen::Vector2d(bounds_of(state.region).center());
  const Pose2 reference{place.x(), place.y(), mean_of(state.heading_rad)};
  const Eigen::Vector2d centre = reference * middle_in_shape;
  return {.t_s = clock.seconds(state.time_step.least),
          .x_m = centre.x(),
          .y_m = centre.y(),
          .heading_rad = reference.heading_rad,
          .speed_mps = mean_of(state.speed_mps)};
}

ObstacleInSource box_over_time(const Recorded& from, const Eigen::Vector2d& size_m,
                               std::vector<TrajectoryPoint> points, const TimeSpan& there) {
  constexpr double moment_s = 1e-6;  // times of a drive and of a recording are rounded differently
  return {.id = from.id,
          .kind = from.type,
          .length_m = size_m.x(),
          .width_m = size_m.y(),
          .motion = geometry::Trajectory(std::move(points)),
          .validity = {there.from_s - moment_s, there.to_s + moment_s}};
}

struct StandingBox {
  Pose2 centre;
  Eigen::Vector2d size_m;  // along its heading, and across
};

// The rectangle along a direction that just holds all corners.
StandingBox box_along(const Eigen::Vector2d& ahead, const geometry::Ring& corners) {
  const Eigen::Vector2d left(-ahead.y(), ahead.x());
  Eigen::AlignedBox2d box;
  for (const Eigen::Vector2d& corner : corners) {
    box.extend(Eigen::Vector2d(corner.dot(ahead), corner.dot(left)));
  }
  const Eigen::Vector2d middle = box.center().x() * ahead + box.center().y() * left;
  return {{middle.x(), middle.y(), std::atan2(ahead.y(), ahead.x())}, box.sizes()};
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
    if (box.size_m.prod() < less * best.size_m.x() * best.size_m.y()) best = box;
  }
  return best;
}

StandingBox box_of(const Shape::value_type& part) {
  if (const auto* polygon = std::get_if<PolygonShape>(&part)) {
    return tightest_box(polygon->corners_m);
  }
  if (const auto* rectangle = std::get_if<RectangleShape>(&part)) {
    const Eigen::Vector2d& centre = rectangle->centre_m;
    return {{centre.x(), centre.y(), rectangle->heading_rad},
            {rectangle->length_m, rectangle->width_m}};
  }
  const Eigen::AlignedBox2d around = bounds_of(Shape(1, part));
  return {{around.center().x(), around.center().y(), 0.0}, around.sizes()};
}

/// The boxes of one obstacle.
class RecordedBoxes {
 public:
  RecordedBoxes(const std::string& file, const Recorded& from, const RecordingClock& clock)
      : file_(file), from_(from), clock_(clock) {}

  std::vector<ObstacleInSource> take() {
    check_parts();
    if (from_.role == ObstacleRole::environment) {
      add_standing(from_.shape, kAlways);
    } else if (from_.initial_state) {
      add_states();
    }
    for (const Occupancy& part : from_.occupancy_set) {
      if (part.region.empty()) {
        refuse(fmt::format("an occupancy at time step {} without a shape", part.time_step.least),
               "a rectangle, circle or polygon");
      }
      add_standing(part.region,
                   {clock_.seconds(part.time_step.least), clock_.seconds(part.time_step.most + 1)});
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

  void add_standing(const Shape& shape, const TimeSpan& there) {
    for (const auto& part : shape) {
      const StandingBox box = box_of(part);
      const Pose2& at = box.centre;
      boxes_.push_back(
          box_over_time(from_, box.size_m,
                        {{.x_m = at.x_m, .y_m = at.y_m, .heading_rad = at.heading_rad}}, there));
    }
  }

  void add_states() {
    const Eigen::AlignedBox2d shape = bounds_of(from_.shape);
    std::vector<TrajectoryPoint> points{exact_point_of(*from_.initial_state, shape.center())};
    for (const State& state : from_.trajectory) {
      const TrajectoryPoint point = exact_point_of(state, shape.center());
      if (!(point.t_s > points.back().t_s)) {
        refuse(fmt::format("the state of time step {} does not follow the one before",
                           state.time_step.least),
               "states in order of time");
      }
      points.push_back(point);
    }
    TimeSpan there = kAlways;
    if (!from_.trajectory.empty()) {
      there = {points.front().t_s, points.back().t_s};
    } else if (!from_.occupancy_set.empty()) {
      there = {points.front().t_s, clock_.seconds(from_.initial_state->time_step.least + 1)};
    }
    boxes_.push_back(box_over_time(from_, shape.sizes(), std::move(points), there));
  }

  TrajectoryPoint exact_point_of(const State& state, const Eigen::Vector2d& middle_in_shape) const {
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
    return point_of(state, middle_in_shape, clock_);
  }

  void set_ids() {
    if (boxes_.size() == 1) return;
    for (std::size_t i = 0; i < boxes_.size(); ++i) {
      boxes_[i].id += fmt::format(".{}", i + 1);
    }
  }

  const std::string& file_;
  const Recorded& from_;
  const RecordingClock& clock_;
  std::vector<ObstacleInSource> boxes_;
};

/// An occupancy set for a simulation.
class OccupancyPieces {
 public:
  OccupancyPieces(const Recorded& from, const RecordingClock& clock) : from_(from), clock_(clock) {
    const Eigen::AlignedBox2d shape = bounds_of(from.shape);
    const TrajectoryPoint start = point_of(*from.initial_state, shape.center(), clock);
    add(0, {from.initial_state->time_step.least, {start.pose(), shape.sizes()}});
    for (const Occupancy& part : from.occupancy_set) {
      for (std::size_t i = 0; i < part.region.size(); ++i) {
        add(i, {part.time_step.least, box_of(part.region[i])});
        last_step_ = std::max(last_step_, part.time_step.most);
      }
    }
  }

  std::vector<ObstacleInSource> take() const {
    std::vector<ObstacleInSource> pieces;
    for (const std::vector<Moment>& part : parts_) {
      for (std::size_t k = 0; k < part.size(); ++k) pieces.push_back(piece(part, k));
    }
    return pieces;
  }

 private:
  struct Moment {
    long step;
    StandingBox box;
  };

  /// What the set says of a time step stands in place of the initial state.
  void add(std::size_t part, const Moment& moment) {
    if (parts_.size() <= part) parts_.resize(part + 1);
    std::vector<Moment>& moments = parts_[part];
    while (!moments.empty() && moments.back().step >= moment.step) moments.pop_back();
    moments.push_back(moment);
    last_step_ = std::max(last_step_, moment.step);
  }

  /// The box of one moment, on the way that the boxes' centres go: its speed is known then.
  ObstacleInSource piece(const std::vector<Moment>& part, std::size_t k) const {
    std::vector<TrajectoryPoint> way;
    for (const Moment& moment : part) {
      way.push_back({.t_s = clock_.seconds(moment.step),
                     .x_m = moment.box.centre.x_m,
                     .y_m = moment.box.centre.y_m,
                     .heading_rad = part[k].box.centre.heading_rad});
    }
    for (std::size_t i = 0; i + 1 < way.size(); ++i) {
      const Eigen::Vector2d step = way[i + 1].pose().position() - way[i].pose().position();
      way[i].speed_mps = step.norm() / (way[i + 1].t_s - way[i].t_s);
    }
    if (way.size() > 1) way.back().speed_mps = way[way.size() - 2].speed_mps;
    constexpr double before_next_s = 2e-6;  // never both, in spite of rounding
    const double to_s = k + 1 < part.size() ? clock_.seconds(part[k + 1].step) - before_next_s
                                            : clock_.seconds(last_step_);
    return box_over_time(from_, part[k].box.size_m, std::move(way),
                         {clock_.seconds(part[k].step), to_s});
  }

  const Recorded& from_;
  const RecordingClock& clock_;
  std::vector<std::vector<Moment>> parts_;
  long last_step_ = std::numeric_limits<long>::min();
};

}  // namespace

std::vector<ObstacleInSource> recorded_obstacles(const Recorded& from,
                                                 const RecordingClock& clock) {
  if (!from.occupancy_set.empty()) return OccupancyPieces(from, clock).take();
  const Eigen::AlignedBox2d box = bounds_of(from.shape);
  std::vector<TrajectoryPoint> points;
  const auto add = [&](const TrajectoryPoint& point) {
    if (points.empty() || point.t_s > points.back().t_s) points.push_back(point);
  };
  add(point_of(*from.initial_state, box.center(), clock));
  for (const State& state : from.trajectory) add(point_of(state, box.center(), clock));
  const bool moves = points.size() > 1;
  const TimeSpan there = moves ? TimeSpan{points.front().t_s, points.back().t_s} : kAlways;
  ObstacleInSource obstacle = box_over_time(from, box.sizes(), std::move(points), there);
  if (obstacle.kind.empty()) obstacle.kind = "car";
  return {obstacle};
}

std::optional<long> initial_step(const map::commonroad::Scenario& scenario) {
  if (scenario.planning_problems.empty()) return std::nullopt;
  return scenario.planning_problems.front().initial_state.time_step.least;
}

std::vector<ObstacleInSource> recorded_boxes(const map::commonroad::Scenario& scenario,
                                             long start_step, const std::string& name) {
  const RecordingClock clock{.start_step = start_step, .step_s = scenario.time_step_s};
  std::vector<ObstacleInSource> boxes;
  for (const Recorded& obstacle : scenario.obstacles) {
    for (ObstacleInSource& box : RecordedBoxes(name, obstacle, clock).take()) {
      boxes.push_back(std::move(box));
    }
  }
  return boxes;
}

}  // namespace roadbed::planning::obstacles
