#include "roadbed/planning/maneuvers/within_lane_passing.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <span>
#include <vector>

namespace roadbed::planning::inline maneuvers {
namespace {

constexpr double kBesideCyclist_m = 1.5;
constexpr double kRidesAlong = 0.8;                      // cosine, of who rides as the vehicle does
constexpr double kReach_m = 25.0;                        // of a path that begins to pass
constexpr double kBraking_mps2 = 1.5, kBefore_m = 10.0;  // with which one would close up
constexpr double kSlowerBy_mps = 1.0, kBehindWithin_s = 8.0, kMovesAlong_mps = 0.3;

bool is_cyclist(const Obstacle& obstacle) { return obstacle.kind == "bicycle"; }

const MoverOnLine* slower_ahead(const WithinLaneQuestion& q,
                                const std::vector<MoverOnLine>& movers) {
  const MoverOnLine* nearest = nullptr;
  const double rear_m = q.view.at.s_m - q.vehicle.rear_overhang_m;
  for (const MoverOnLine& mover : movers) {
    if (mover.front_m() < rear_m || !mover.shares_way(0.0, q.vehicle)) continue;
    if (!nearest || mover.s_m < nearest->s_m) nearest = &mover;
  }
  if (!nearest || nearest->speed_mps < kMovesAlong_mps) return nullptr;
  const double gap_m = nearest->rear_m() - q.view.at.s_m - q.vehicle.front_m();
  const double slower_mps = q.free_mps - nearest->speed_mps;
  const double closing_mps = std::max(0.0, q.view.speed_mps - nearest->speed_mps);
  const double braking_m = 0.5 * closing_mps * closing_mps / kBraking_mps2 + kBefore_m;
  const bool is_soon =
      gap_m < std::min(std::max(kReach_m, braking_m), kBehindWithin_s * slower_mps);
  return slower_mps >= kSlowerBy_mps && is_soon ? nearest : nullptr;
}

/// Whether somebody slow drives behind somebody slow. Cyclists ride behind one another everywhere.
bool queues(const WithinLaneQuestion& q, const std::vector<MoverOnLine>& movers,
            const MoverOnLine& mover) {
  const std::span<const Obstacle> obstacles = q.view.traffic.obstacles;
  if (mover.speed_mps > kQueue_mps || is_cyclist(obstacles[mover.obstacle])) return false;
  return std::ranges::any_of(movers, [&](const MoverOnLine& other) {
    return other.speed_mps < kQueue_mps && other.is_closely_ahead_of(mover);
  });
}

/// Metres that are missing beside it, on the side where fewer are.
double missing_m(const WithinLaneQuestion& q, const MoverOnLine& mover) {
  const double half_m = 0.5 * q.vehicle.width_m;
  const double needed_m = mover.half_width_m + q.clearance_m + half_m;  // to the vehicle's middle
  const Corridor corridor = q.line.corridor_at(mover.s_m);
  const double left_m = std::min(corridor.left_m - half_m, q.most_left_m) - mover.d_m;
  const double right_m = std::min(corridor.right_m - half_m, q.most_right_m) + mover.d_m;
  return needed_m - std::max(left_m, right_m);
}

}  // namespace

std::optional<std::vector<Obstacle>> with_room_beside_cyclists(std::span<const Obstacle> obstacles,
                                                               double t_s,
                                                               const geometry::Rectangle& body,
                                                               double clearance_m) {
  const double wider_m = 2.0 * (kBesideCyclist_m - clearance_m);
  if (std::ranges::none_of(obstacles, is_cyclist) || wider_m <= 0.0) return std::nullopt;
  std::vector<Obstacle> kept_from(obstacles.begin(), obstacles.end());
  for (Obstacle& obstacle : kept_from) {
    if (!is_cyclist(obstacle) || obstacle.is_static()) continue;
    if (obstacle.motion.at(t_s).speed_mps < kMovesAlong_mps) continue;
    const geometry::Rectangle own = rectangle_at(obstacle, t_s);
    obstacle.width_m += wider_m;
    const bool is_beside = geometry::distance_m(rectangle_at(obstacle, t_s), body) <= 0.0;
    if (is_beside || own.axis.dot(body.axis) < kRidesAlong) obstacle.width_m -= wider_m;
  }
  return kept_from;
}

WithinLanePassing look_within_lane(const WithinLaneQuestion& question) {
  const std::vector<MoverOnLine> movers =
      movers_on_line(question.line, question.view.traffic, question.view.t_s);
  const MoverOnLine* slower = slower_ahead(question, movers);
  if (slower == nullptr) return {};
  const Obstacle& obstacle = question.view.traffic.obstacles[slower->obstacle];
  const auto because = [&](const char* why) {
    return WithinLanePassing{.reason = fmt::format("{} is not passed: {}", obstacle.id, why)};
  };
  if (is_braking(obstacle, question.view.t_s)) return because("it brakes");
  const double missing = missing_m(question, *slower);
  if (missing <= 0.0 && queues(question, movers, *slower)) return because("it queues");
  if (missing <= 0.0) return {.passed = slower->obstacle};
  return {.reason = fmt::format("{} is not passed: {:.1f} m of room are missing beside it",
                                obstacle.id, missing)};
}

}  // namespace roadbed::planning::maneuvers
