#include "roadbed/planning/right_of_way/hidden_walkers.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include "roadbed/planning/obstacles/visibility.h"
#include "roadbed/planning/speed/lead.h"

namespace roadbed::planning::inline right_of_way {
namespace {

constexpr double kWalks_mps = 1.4, kReacts_s = 0.5, kWalkingPace_mps = 2.8;
constexpr double kNobodyWalks_mps = 61.0 / 3.6;  // limits above it
constexpr double kFarthestAside_m = 4.0, kAsideStep_m = 0.25;
constexpr double kWalkerRadius_m = 0.2;
constexpr double kCoverWithin_m = 2.0 * kFarthestAside_m;  // farther away nothing hides anybody
constexpr double kAllRange_m = 1e3;
constexpr double kSmall_m = 1.0;  // what is no longer hides nobody

/// What stands near the path, and what is seen past it.
class Surroundings {
 public:
  Surroundings(const PathProfile& path, const DrivingTask& task, const Traffic& traffic, double t_s)
      : task_(task),
        standing_(standing_beside(path, traffic, t_s)),
        sight_(path.body.front(), kAllRange_m, standing_, task.field, task.road_map) {}

  bool is_near(const Eigen::Vector2d& point, double within_m) const {
    return (task_.field && to_cells_m(point) < within_m) ||
           std::ranges::any_of(standing_, [&](const geometry::Rectangle& body) {
             return geometry::distance_m(body, point) < within_m;
           });
  }

  bool is_taken(const Eigen::Vector2d& point) const { return is_near(point, kWalkerRadius_m); }

  bool sees(const Eigen::Vector2d& point) const { return sight_.sees(point); }

 private:
  static std::vector<geometry::Rectangle> standing_beside(const PathProfile& path,
                                                          const Traffic& traffic, double t_s) {
    std::vector<geometry::Rectangle> bodies;
    const geometry::Rectangle& vehicle = path.body.front();
    for (const Obstacle& other : traffic.obstacles) {
      if (!other.is_static() || !other.is_there(t_s) || other.length_m < kSmall_m) continue;
      const geometry::Rectangle body = rectangle_at(other, t_s);
      const double away_m = (body.centre - vehicle.centre).norm() - body.radius_m();
      if (away_m < path.length_m() + vehicle.radius_m()) bodies.push_back(body);
    }
    return bodies;
  }

  double to_cells_m(const Eigen::Vector2d& point) const {
    return task_.field->distance_bound_m(task_.road_map.to_source(point));
  }

  const DrivingTask& task_;
  std::vector<geometry::Rectangle> standing_;
  Visibility sight_;
};

/// How far from a place at the body's side somebody may be hidden who can walk to it.
std::optional<double> nearest_hidden_m(const Surroundings& around, const Eigen::Vector2d& side,
                                       const Eigen::Vector2d& outwards) {
  double seen_m = 0.0;
  for (double aside_m = kAsideStep_m; aside_m <= kFarthestAside_m; aside_m += kAsideStep_m) {
    const Eigen::Vector2d point = side + aside_m * outwards;
    if (around.is_taken(point)) return std::nullopt;
    if (!around.sees(point)) return seen_m;
    seen_m = aside_m;
  }
  return std::nullopt;
}

}  // namespace

double speed_past_walker_mps(double aside_m) {
  const double in_the_way_after_s = aside_m / kWalks_mps;
  return std::max(kWalkingPace_mps, SafetyOptions{}.most_mps2 * (in_the_way_after_s - kReacts_s));
}

std::vector<HiddenWalker> find_hidden_walkers(const WalkerQuestion& q) {
  const PathProfile& path = q.path;
  const Surroundings around(path, q.task, q.traffic, q.t_s);
  std::vector<HiddenWalker> walkers;
  for (std::size_t i = 0; i < path.body.size(); ++i) {
    const geometry::Rectangle& body = path.body[i];
    const Eigen::Vector2d front = body.centre + body.half_length_m * body.axis;
    if (!around.is_near(front, kCoverWithin_m)) continue;
    if (around.is_taken(front)) break;  // no farther
    if (q.line.corridor_at(path.station_m[i]).speed_limit_mps > kNobodyWalks_mps) continue;
    const Eigen::Vector2d left(-body.axis.y(), body.axis.x());
    for (const double side : {1.0, -1.0}) {
      const auto aside_m =
          nearest_hidden_m(around, front + side * 0.5 * q.vehicle.width_m * left, side * left);
      if (!aside_m) continue;
      const double most_mps = speed_past_walker_mps(*aside_m);
      if (most_mps < path.wanted_mps[i]) walkers.push_back({path.ahead_m[i], *aside_m, most_mps});
    }
  }
  return walkers;
}

SpeedTarget speed_before_walkers(std::span<const HiddenWalker> walkers, double driven_m,
                                 double deceleration_mps2) {
  SpeedTarget least{.speed_mps = std::numeric_limits<double>::infinity()};
  for (const HiddenWalker& walker : walkers) {
    const double left_m = walker.ahead_m - driven_m;
    if (left_m < 0.0) continue;
    const double most_mps =
        std::sqrt(walker.most_mps * walker.most_mps + 2.0 * deceleration_mps2 * left_m);
    if (most_mps < least.speed_mps) least = {most_mps, left_m > 0.0 ? -deceleration_mps2 : 0.0};
  }
  return least;
}

}  // namespace roadbed::planning::right_of_way
