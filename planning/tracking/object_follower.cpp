#include "roadbed/planning/tracking/object_follower.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <stdexcept>
#include <utility>

#include "roadbed/planning/tracking/assignment.h"

namespace roadbed::planning::inline tracking {
namespace {

using geometry::Rectangle;
using Sight = FollowedObject::Sight;

Eigen::Vector2d left_of(const Eigen::Vector2d& axis) { return {-axis.y(), axis.x()}; }

/// The same rectangle with the one of its four axes that is nearest to a direction.
Rectangle turned_towards(const Rectangle& box, const Eigen::Vector2d& direction) {
  const double along = box.axis.dot(direction), left = left_of(box.axis).dot(direction);
  if (std::abs(along) >= std::abs(left)) {
    return {box.centre, along < 0.0 ? Eigen::Vector2d(-box.axis) : box.axis, box.half_length_m,
            box.half_width_m};
  }
  return {box.centre, left_of(box.axis) * (left < 0.0 ? -1.0 : 1.0), box.half_width_m,
          box.half_length_m};
}

/// From where to where rectangles reach along an axis.
struct Reach {
  double from_m = INFINITY, to_m = -INFINITY;

  void add(const Rectangle& box, const Eigen::Vector2d& axis) {
    for (const Eigen::Vector2d& corner : box.corners()) {
      from_m = std::min(from_m, axis.dot(corner));
      to_m = std::max(to_m, axis.dot(corner));
    }
  }
  double middle_m() const { return 0.5 * (from_m + to_m); }
  double length_m() const { return to_m - from_m; }
};

/// Along the largest box, around all of them.
Rectangle around(const std::vector<Sight>& sights) {
  const Rectangle& largest = std::ranges::max_element(sights, {}, [](const Sight& sight) {
                               return sight.box.half_length_m * sight.box.half_width_m;
                             })->box;
  const Eigen::Vector2d left = left_of(largest.axis);
  Reach along, across;
  for (const Sight& sight : sights) {
    along.add(sight.box, largest.axis);
    across.add(sight.box, left);
  }
  return {along.middle_m() * largest.axis + across.middle_m() * left, largest.axis,
          0.5 * along.length_m(), 0.5 * across.length_m()};
}

/// Of its way: what has come less far shakes.
constexpr double kLeastStraight = 0.5;

/// What nothing is flatter than: surfaces are measured to some centimetres.
constexpr double kLeastSide_m = 0.1;

// Of half a side; 0 to 1.
double relative_difference(double a_m, double b_m) {
  return std::abs(a_m - b_m) / std::max({a_m, b_m, kLeastSide_m});
}

geometry::TrajectoryPoint row(double t_s, const Rectangle& box) {
  return {.t_s = t_s,
          .x_m = box.centre.x(),
          .y_m = box.centre.y(),
          .heading_rad = std::atan2(box.axis.y(), box.axis.x())};
}

void hold(ObstacleInSource& obstacle, const Rectangle& box) {
  obstacle.length_m = std::max(obstacle.length_m, 2.0 * box.half_length_m);
  obstacle.width_m = std::max(obstacle.width_m, 2.0 * box.half_width_m);
}

ObstacleInSource without_motion(std::size_t number) {
  return {.id = fmt::format("object {}", number),
          .kind = "object",
          .length_m = kLeastSide_m,
          .width_m = kLeastSide_m,
          .motion = {}};
}

ObstacleInSource standing(std::size_t number, const std::vector<Sight>& sights) {
  ObstacleInSource obstacle = without_motion(number);
  const Rectangle box = around(sights);
  hold(obstacle, box);
  obstacle.motion = geometry::Trajectory({row(sights.front().t_s, box)});
  return obstacle;
}

ObstacleInSource moving(std::size_t number, const FollowedObject& object, double until_s) {
  ObstacleInSource obstacle = without_motion(number);
  const std::vector<Sight>& sights = object.sights;
  Eigen::Vector2d front = sights.back().box.centre - sights.front().box.centre;
  if (sights.size() == 1) front = sights.front().box.axis;
  std::vector<geometry::TrajectoryPoint> rows;
  for (const Sight& sight : sights) {
    const Rectangle box = turned_towards(sight.box, front);
    front = box.axis;
    hold(obstacle, box);
    rows.push_back(row(sight.t_s, box));
  }
  geometry::TrajectoryPoint last = rows.back();
  const Eigen::Vector2d way_m = object.velocity_mps * (until_s - last.t_s);
  last.t_s = until_s;
  last.x_m += way_m.x();
  last.y_m += way_m.y();
  rows.push_back(last);
  obstacle.motion = geometry::Trajectory(std::move(rows));
  obstacle.validity = {obstacle.motion.start_s(), obstacle.motion.end_s()};
  return obstacle;
}

}  // namespace

void ObjectFollower::observe(double t_s, std::span<const Rectangle> boxes) {
  if (!times_s_.empty() && !(t_s > times_s_.back())) {
    throw std::invalid_argument(
        fmt::format("ObjectFollower: {} s does not come after {} s", t_s, times_s_.back()));
  }
  times_s_.push_back(t_s);
  std::vector<std::size_t> alive;
  for (std::size_t i = 0; i < objects_.size(); ++i) {
    if (t_s - objects_[i].sights.back().t_s <= options_.coasts_for_s) alive.push_back(i);
  }
  std::vector<PossiblePair> pairs;
  for (std::size_t row = 0; row < alive.size(); ++row) {
    for (std::size_t column = 0; column < boxes.size(); ++column) {
      const double costs = cost(objects_[alive[row]], boxes[column], t_s);
      if (costs <= 1.0) pairs.push_back({row, column, costs});
    }
  }
  std::vector<bool> is_given(boxes.size(), false);
  const auto columns = assign(alive.size(), boxes.size(), pairs, 1.0);
  for (std::size_t row = 0; row < alive.size(); ++row) {
    if (!columns[row]) continue;
    is_given[*columns[row]] = true;
    FollowedObject& object = objects_[alive[row]];
    const Rectangle& box = boxes[*columns[row]];
    const Sight& before = object.sights.back();
    const Eigen::Vector2d measured_mps = (box.centre - before.box.centre) / (t_s - before.t_s);
    const double trust = object.sights.size() == 1 ? 1.0 : 0.5;
    object.velocity_mps += trust * (measured_mps - object.velocity_mps);
    object.sights.push_back({t_s, box});
  }
  for (std::size_t column = 0; column < boxes.size(); ++column) {
    if (!is_given[column]) objects_.push_back({.sights = {{t_s, boxes[column]}}});
  }
}

// 0 is a perfect fit, 1 the worst that may be.
double ObjectFollower::cost(const FollowedObject& object, const Rectangle& box, double t_s) const {
  const Sight& last = object.sights.back();
  const double since_s = t_s - last.t_s;
  const double may_differ_mps =
      object.sights.size() == 1 ? options_.fastest_mps : options_.speed_change_mps;
  const Eigen::Vector2d foreseen = last.box.centre + since_s * object.velocity_mps;
  const double differ_m = (box.centre - foreseen).norm();
  return differ_m / (options_.shift_m + may_differ_mps * since_s) +
         0.5 * (relative_difference(box.half_length_m, last.box.half_length_m) +
                relative_difference(box.half_width_m, last.box.half_width_m));
}

// The first time at which it was not seen any more; where there is none, one step later than all.
double ObjectFollower::gone_s(const FollowedObject& object) const {
  const double last_s = object.sights.back().t_s;
  const auto next = std::ranges::upper_bound(times_s_, last_s);
  if (next != times_s_.end()) return *next;
  return last_s + (last_s - times_s_[times_s_.size() - 2]);
}

// Both ends, or both sides, have gone the same way, and not to and fro: one alone moves where more
// is seen, and of a wall now one piece shows and now another.
bool ObjectFollower::moves(const FollowedObject& object) const {
  double way_m = 0.0;
  for (std::size_t i = 1; i < object.sights.size(); ++i) {
    way_m += (object.sights[i].box.centre - object.sights[i - 1].box.centre).norm();
  }
  const double gone_m = (object.sights.back().box.centre - object.sights.front().box.centre).norm();
  if (gone_m < kLeastStraight * way_m) return false;
  const Rectangle& first = object.sights.front().box;
  for (const Eigen::Vector2d& axis : {first.axis, left_of(first.axis)}) {
    Reach before, after;
    before.add(first, axis);
    after.add(object.sights.back().box, axis);
    const double rear_m = after.from_m - before.from_m, front_m = after.to_m - before.to_m;
    if (rear_m * front_m > 0.0 &&
        std::min(std::abs(rear_m), std::abs(front_m)) > options_.moves_m) {
      return true;
    }
  }
  return false;
}

std::vector<ObstacleInSource> ObjectFollower::obstacles() const {
  std::vector<ObstacleInSource> obstacles;
  for (std::size_t i = 0; i < objects_.size(); ++i) {
    const FollowedObject& object = objects_[i];
    const bool seen_once = object.sights.size() == 1 && times_s_.size() > 1;
    obstacles.push_back(seen_once || moves(object) ? moving(i + 1, object, gone_s(object))
                                                   : standing(i + 1, object.sights));
  }
  return obstacles;
}

}  // namespace roadbed::planning::tracking
