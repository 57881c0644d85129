#include "roadbed/tools/simulation/traffic_flow.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <utility>

#include "roadbed/planning/speed/lead.h"

namespace roadbed::tools::inline simulation {
namespace {

using geometry::Rectangle;
using geometry::TrajectoryPoint;
using planning::ZipBody;
using planning::ZipMerge;

constexpr double kNear_m = 120.0;  // beyond it nobody is followed
constexpr double kLeastGap_m = 0.01;
constexpr double kInfinity_m = std::numeric_limits<double>::infinity();

/// Half of what a body measures along a direction.
double half_extent_m(const Rectangle& body, const Eigen::Vector2d& along) {
  const double c = std::abs(body.axis.dot(along));
  const double s = std::sqrt(std::max(0.0, 1.0 - c * c));
  return c * body.half_length_m + s * body.half_width_m;
}

TrajectoryPoint point_at(const LaneDriver& driver, double t_s, double s_m, double speed_mps) {
  const geometry::Pose2 pose = driver.way(std::min(s_m, driver.way_length_m));
  return {.t_s = t_s,
          .x_m = pose.x_m,
          .y_m = pose.y_m,
          .heading_rad = pose.heading_rad,
          .speed_mps = s_m < driver.way_length_m ? speed_mps : 0.0};
}

}  // namespace

TrafficFlow::TrafficFlow(const std::vector<LaneDriver>& drivers,
                         std::vector<planning::Obstacle>& obstacles, double duration_s,
                         const Options& options)
    : obstacles_(obstacles), options_(options) {
  for (const LaneDriver& driver : drivers) {
    const auto found = std::ranges::find(obstacles_, driver.obstacle, &planning::Obstacle::id);
    if (found == obstacles_.end()) continue;
    found->motion =
        drive_along(driver.way, driver.way_length_m, driver.speeds, duration_s + kForeseenFor_s);
    cars_.push_back({.driver = &driver,
                     .obstacle = static_cast<std::size_t>(found - obstacles_.begin()),
                     .s_m = 0.0,
                     .speed_mps = wanted_speed_mps(driver.speeds, 0.0),
                     .hindered = false});
  }
}

void TrafficFlow::step(const DrivenBody& vehicle) {
  const std::vector<Body> around = movers(vehicle);
  take_turns(around);
  std::vector<double> braking;
  for (const Car& car : cars_) {
    braking.push_back(
        std::min(braking_mps2(car, ahead_of(car, vehicle)), letting_in_mps2(car, around)));
  }
  ++steps_;
  for (std::size_t i = 0; i < cars_.size(); ++i) drive(cars_[i], braking[i]);
}

/// The nearest body on the way.
TrafficFlow::Ahead TrafficFlow::ahead_of(const Car& car, const DrivenBody& vehicle) const {
  const double t_s = kStep_s * steps_;
  const planning::Obstacle& own = obstacles_[car.obstacle];
  const Eigen::Vector2d here = own.motion.at(t_s).pose().position();
  Ahead nearest{kInfinity_m, 0.0};
  const auto look_at = [&](const Rectangle& body, double speed_mps) {
    if ((body.centre - here).norm() > kNear_m) return;
    const geometry::LinePosition at = car.driver->place_of(body.centre);
    const double heading = car.driver->way(at.s_m).heading_rad;
    const Eigen::Vector2d along(std::cos(heading), std::sin(heading));
    const Eigen::Vector2d across(-along.y(), along.x());
    const bool beside = std::abs(at.d_m) > 0.5 * own.width_m + half_extent_m(body, across);
    const double gap_m = at.s_m - half_extent_m(body, along) - car.s_m - 0.5 * own.length_m;
    if (beside || at.s_m <= car.s_m || gap_m >= nearest.gap_m) return;
    nearest = {gap_m, speed_mps * body.axis.dot(along)};
  };
  look_at(vehicle.body, vehicle.speed_mps);
  for (std::size_t i = 0; i < obstacles_.size(); ++i) {
    // Who is away from the vehicle's route is not away for others.
    if (i == car.obstacle || !obstacles_[i].validity.holds(t_s)) continue;
    const double speed = obstacles_[i].is_static() ? 0.0 : obstacles_[i].motion.at(t_s).speed_mps;
    look_at(rectangle_at(obstacles_[i], t_s), speed);
  }
  return nearest;
}

/// Acceleration that keeps the distance, 0 or less; infinite: nothing hinders.
double TrafficFlow::braking_mps2(const Car& car, const Ahead& ahead) const {
  const double closing = car.speed_mps - ahead.speed_mps;
  const double dynamic_m =
      car.speed_mps * options_.headway_s +
      car.speed_mps * closing / (2.0 * std::sqrt(options_.speeds_up_mps2 * options_.brakes_mps2));
  const double wanted_m = options_.standstill_m + std::max(0.0, dynamic_m);
  const double z = wanted_m / std::max(kLeastGap_m, ahead.gap_m);
  if (z < 1.0) return kInfinity_m;
  return std::max(options_.speeds_up_mps2 * (1.0 - z * z), -options_.hardest_mps2);
}

std::vector<TrafficFlow::Body> TrafficFlow::movers(const DrivenBody& vehicle) const {
  std::vector<Body> all;
  const double t_s = kStep_s * steps_;
  for (std::size_t i = 0; i < obstacles_.size(); ++i) {
    if (obstacles_[i].is_static() || !obstacles_[i].validity.holds(t_s)) continue;
    all.push_back({obstacles_[i].id, rectangle_at(obstacles_[i], t_s),
                   obstacles_[i].motion.at(t_s).speed_mps});
  }
  all.push_back({{}, vehicle.body, vehicle.speed_mps});
  return all;
}

/// Of the front bumper.
double TrafficFlow::to_end_m(const Car& car, const LaneEndBeside& beside) const {
  return beside.at.s_m - car.s_m - 0.5 * obstacles_[car.obstacle].length_m;
}

/// Those in a lane that ends beside a car's way, the foremost first.
std::vector<ZipBody> TrafficFlow::waiting_at(const Car& car, const LaneEndBeside& beside,
                                             const std::vector<Body>& movers) const {
  constexpr double kInItsLane_m = 1.2;
  const Eigen::Vector2d end_in_map = car.driver->way(beside.at.s_m).position();
  std::vector<ZipBody> waiting;
  for (const Body& other : movers) {
    if ((other.body.centre - end_in_map).norm() > ZipMerge::kSeenFrom_m) continue;
    const geometry::LinePosition at = car.driver->place_of(other.body.centre);
    const double front_m = beside.at.s_m - at.s_m - other.body.half_length_m;
    if (std::abs(at.d_m - beside.at.d_m) > kInItsLane_m || front_m > ZipMerge::kInTurn_m) continue;
    waiting.push_back({other.id, front_m, 2.0 * other.body.half_length_m, other.speed_mps});
  }
  std::ranges::stable_sort(waiting, {}, &ZipBody::to_end_m);
  return waiting;
}

void TrafficFlow::take_turns(const std::vector<Body>& movers) {
  struct Queue {
    const Car& sees;
    const LaneEndBeside& beside;
    std::vector<ZipBody> drivers;
  };
  std::map<std::size_t, Queue> queues;
  for (const Car& car : cars_) {
    for (const LaneEndBeside& beside : car.driver->lane_ends) {
      const double left_m = to_end_m(car, beside);
      if (left_m < 0.0 || left_m > ZipMerge::kSeenFrom_m) continue;
      Queue& queue = queues.try_emplace(beside.end, Queue{car, beside, {}}).first->second;
      queue.drivers.push_back(
          {obstacles_[car.obstacle].id, left_m, obstacles_[car.obstacle].length_m, car.speed_mps});
    }
  }
  for (auto& [end, queue] : queues) {
    std::ranges::stable_sort(queue.drivers, {}, &ZipBody::to_end_m);
    zip_.update(end, queue.drivers, waiting_at(queue.sees, queue.beside, movers));
  }
}

/// As braking_mps2(), behind who is let in and is not in the own lane yet.
double TrafficFlow::letting_in_mps2(const Car& car, const std::vector<Body>& movers) const {
  for (const LaneEndBeside& beside : car.driver->lane_ends) {
    const auto who = zip_.let_in(beside.end, obstacles_[car.obstacle].id);
    if (!who) continue;
    for (const ZipBody& waits : waiting_at(car, beside, movers)) {
      if (waits.id != *who) continue;
      const double gap_m = to_end_m(car, beside) - waits.to_end_m - waits.length_m;
      return std::max(braking_mps2(car, {gap_m, waits.speed_mps}), -ZipMerge::kMostBraking_mps2);
    }
  }
  return kInfinity_m;
}

void TrafficFlow::drive(Car& car, double braking) {
  const double t_s = kStep_s * steps_;
  const double wanted = wanted_speed_mps(car.driver->speeds, t_s);
  if (!car.hindered && std::isinf(braking)) {  // exactly as its speeds say
    car.s_m = travelled_m(car.driver->speeds, t_s);
    car.speed_mps = wanted;
    return;
  }
  car.hindered = true;
  const double free_mps = std::min(car.speed_mps + options_.speeds_up_mps2 * kStep_s, wanted);
  const double kept_mps = std::isinf(braking) ? free_mps : car.speed_mps + braking * kStep_s;
  const double before_mps = std::exchange(car.speed_mps, std::clamp(kept_mps, 0.0, free_mps));
  car.s_m += 0.5 * (before_mps + car.speed_mps) * kStep_s;
  foresee(car);
}

/// What it has done stays; from now on it keeps its speed.
void TrafficFlow::foresee(const Car& car) {
  std::vector<TrajectoryPoint> points = obstacles_[car.obstacle].motion.points();
  const auto now = std::min(static_cast<std::size_t>(steps_), points.size());
  points.resize(now);
  const double now_s = kStep_s * steps_;
  const auto steps = static_cast<int>(std::lround(kForeseenFor_s / kStep_s));
  for (int k = 0; k <= steps; ++k) {
    const double ahead_s = kStep_s * k;
    points.push_back(
        point_at(*car.driver, now_s + ahead_s, car.s_m + car.speed_mps * ahead_s, car.speed_mps));
  }
  obstacles_[car.obstacle].motion = geometry::Trajectory(std::move(points));
}

}  // namespace roadbed::tools::simulation
