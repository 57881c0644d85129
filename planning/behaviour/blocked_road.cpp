#include "roadbed/planning/behaviour/blocked_road.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "roadbed/planning/obstacles/movers_on_line.h"

namespace roadbed::planning::inline behaviour {
namespace {

constexpr double kHasStopped_mps = 0.3;  // of the vehicle, measured
constexpr double kPatience_s = 10.0, kMorePatience_s = 60.0;
constexpr double kBeforeLine_m = 15.0;  // of a queue's first
constexpr double kBeforeLight_m = 30.0;

/// Who stands next before somebody in a queue.
const MoverOnLine* next_ahead(const std::vector<MoverOnLine>& movers, const MoverOnLine& last,
                              const Traffic& traffic, double t_s) {
  const MoverOnLine* nearest = nullptr;
  for (const MoverOnLine& mover : movers) {
    if (!mover.is_closely_ahead_of(last)) continue;
    if (!is_standing(traffic.obstacles[mover.obstacle], t_s)) continue;
    if (nearest == nullptr || mover.s_m < nearest->s_m) nearest = &mover;
  }
  return nearest;
}

}  // namespace

std::vector<std::size_t> BlockedRoad::queue_ahead(const View& view, double& front_s_m) const {
  const bool waits =
      view.ahead && !view.waits_for_rule && view.measured.speed_mps < kHasStopped_mps;
  if (!waits || !is_standing(view.traffic.obstacles[*view.ahead], view.t_s)) return {};
  const std::vector<MoverOnLine> movers =
      movers_on_line(task_.line, view.traffic, view.t_s, /*with_standing=*/true);
  const auto first = std::ranges::find(movers, *view.ahead, &MoverOnLine::obstacle);
  std::vector<std::size_t> queue;
  for (const MoverOnLine* at = &*first; at != nullptr;
       at = next_ahead(movers, *at, view.traffic, view.t_s)) {
    queue.push_back(at->obstacle);
    front_s_m = at->front_m();
  }
  return queue;
}

bool BlockedRoad::has_moved_on(const View& view) const {
  return std::ranges::any_of(queue_, [&](std::size_t other) {
    return !is_standing(view.traffic.obstacles[other], view.t_s);
  });
}

bool BlockedRoad::stands_at_light(const View& view, double queue_front_s_m) const {
  const double own_s_m = task_.line.project(view.measured.map_from_vehicle.position()).s_m;
  return std::ranges::any_of(task_.stop_points, [&](const StopPoint& place) {
    return place.kind == StopKind::light && place.s_m > own_s_m + vehicle_.front_m() &&
           place.s_m < queue_front_s_m + kBeforeLight_m &&
           colour_at(task_.lights[*place.light], view.t_s) != LightColour::green;
  });
}

/// Three or more who may drive on, not road works or parked cars.
bool BlockedRoad::is_jam(const View& view) const {
  constexpr std::ptrdiff_t least = 3;
  return std::ranges::count_if(queue_, [&](std::size_t other) {
           return !view.traffic.obstacles[other].is_static();
         }) >= least;
}

double BlockedRoad::patience_s(const View& view, double queue_front_s_m) const {
  const bool is_at_line = std::ranges::any_of(task_.stop_points, [&](const StopPoint& place) {
    return place.kind != StopKind::light && place.s_m > queue_front_s_m - vehicle_.length_m &&
           place.s_m < queue_front_s_m + kBeforeLine_m;
  });
  return is_at_line || is_jam(view) ? kMorePatience_s : kPatience_s;
}

std::optional<BlockedRoad::Decision> BlockedRoad::look(const View& view) {
  double front_s_m = 0.0;
  std::vector<std::size_t> queue = queue_ahead(view, front_s_m);
  const bool is_same = !queue.empty() && !queue_.empty() && queue.front() == queue_.front();
  if (!is_same || has_moved_on(view) || stands_at_light(view, front_s_m)) {
    since_s_ = view.t_s;
    reason_.clear();
  }
  queue_ = std::move(queue);
  if (queue_.empty() || view.t_s - since_s_ < patience_s(view, front_s_m)) return std::nullopt;
  std::vector<std::size_t> blockers = is_jam(view) ? std::vector<std::size_t>{} : queue_;
  if (!reason_.empty()) return Decision{reason_, false, std::nullopt, std::move(blockers)};
  DetourAnswer answer = ask(view);
  reason_ = describe(view, answer);
  return Decision{reason_, true, std::move(answer.detour), std::move(blockers)};
}

DetourAnswer BlockedRoad::ask(const View& view) const {
  if (task_.route.legs.empty()) return {{}, "a line of way-points is no route"};
  std::vector<std::size_t> blockers = queue_;
  for (const std::size_t known : known_blockers(task_, view.t_s)) {
    if (std::ranges::count(blockers, known) == 0) blockers.push_back(known);
  }
  return find_detour({.task = task_,
                      .vehicle = vehicle_,
                      .driving = driving_,
                      .measured = view.measured,
                      .t_s = view.t_s,
                      .blockers = std::move(blockers)});
}

std::string BlockedRoad::describe(const View& view, const DetourAnswer& answer) const {
  const Obstacle& first = task_.obstacles[queue_.front()];
  const std::string who = fmt::format("the road is blocked: {} {} has not moved for {:.0f} s",
                                      first.kind, first.id, view.t_s - since_s_);
  if (!answer.detour) return who + "; no other route: " + answer.reason;
  return who + "; " + described(*answer.detour, task_.road_map);
}

}  // namespace roadbed::planning::behaviour
