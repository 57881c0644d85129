#include "roadbed/planning/behaviour/detour.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "roadbed/geometry/motion/rectangle.h"
#include "roadbed/map/index/road_map_index.h"
#include "roadbed/planning/behaviour/lateral_replanner.h"
#include "roadbed/planning/route/match_place.h"
#include "roadbed/planning/route/router.h"

namespace roadbed::planning::inline behaviour {
namespace {

constexpr std::size_t kMostTried = 8;                   // routes that no path leads onto
constexpr double kRaster_m = 0.25, kMostParts = 200.0;  // at which a body is looked at

/// What a body takes of a lane: stations, and offsets of its sides.
struct TakenPart {
  double from_s_m = std::numeric_limits<double>::infinity(), to_s_m = -from_s_m;
  double right_d_m = from_s_m, left_d_m = -from_s_m;
  bool is_on_lane = false;

  void add(const geometry::LinePosition& at, double half_width_m) {
    right_d_m = std::min(right_d_m, at.d_m);
    left_d_m = std::max(left_d_m, at.d_m);
    if (std::abs(at.d_m) >= half_width_m) return;
    is_on_lane = true;
    from_s_m = std::min(from_s_m, at.s_m);
    to_s_m = std::max(to_s_m, at.s_m);
  }
};

int parts_of(double length_m) {
  return static_cast<int>(std::clamp(std::ceil(length_m / kRaster_m), 1.0, kMostParts));
}

TakenPart part_taken(const map::Lane& lane, const geometry::Rectangle& body) {
  TakenPart taken;
  const Eigen::Vector2d across(-body.axis.y(), body.axis.x());
  const int rows = parts_of(2.0 * body.half_length_m), columns = parts_of(2.0 * body.half_width_m);
  for (int i = 0; i <= rows; ++i) {
    for (int j = 0; j <= columns; ++j) {
      const Eigen::Vector2d point = body.centre +
                                    (2.0 * i / rows - 1.0) * body.half_length_m * body.axis +
                                    (2.0 * j / columns - 1.0) * body.half_width_m * across;
      const geometry::LinePosition at = lane.centre.in_map.project(point);
      if (at.s_m <= 0.0 || at.s_m >= lane.length_m()) continue;  // before the lane, or behind it
      taken.add(at, 0.5 * lane.width_m(at.s_m));
    }
  }
  return taken;
}

bool is_on(const Route& route, map::LaneId lane) {
  return std::ranges::any_of(route.legs, [&](const RouteLeg& leg) { return leg.lane == lane; });
}

RoutePlace goal_of(const Route& route) {
  const RouteLeg& last = route.legs.back();
  return {{last.lane, last.to_s_m, 0.0}, last.reversed ? Sense::against : Sense::along};
}

RouteOptions options_without(const DetourQuestion& q) {
  RouteOptions options;
  options.avoid = q.missed;
  for (const std::size_t blocker : q.blockers) {
    const auto closed = stretches_closed_by(q.task.obstacles[blocker], q);
    options.blocked.insert(options.blocked.end(), closed.begin(), closed.end());
  }
  return options;
}

/// Those who stand, the blockers among them: who moves may be gone when the vehicle comes there.
std::vector<Obstacle> standing(const DetourQuestion& q) {
  std::vector<Obstacle> found;
  for (const Obstacle& obstacle : q.task.obstacles) {
    if (!is_standing(obstacle, q.t_s)) continue;
    found.push_back(obstacle);
    found.back().motion = geometry::Trajectory({obstacle.motion.at(q.t_s)});
  }
  return found;
}

/// Whether a path leads onto a line from where the vehicle stands.
bool can_be_joined(const DetourQuestion& q, const ReferenceLine& line) {
  LateralReplanner replanner(q.vehicle, q.task, line,
                             {.tracking_error_m = 0.0,
                              .heading_error_rad = 0.0,
                              .margin_levels = margin_levels_on_route(q.driving.clearance_m),
                              .weights = q.driving.weights});
  replanner.locate(q.measured);
  const std::vector<Obstacle> obstacles = standing(q);
  const LateralReplanner::Question question{.t_s = q.t_s,
                                            .measured = q.measured,
                                            .speed = {.speed_mps = q.measured.speed_mps},
                                            .obstacles = obstacles};
  return replanner.propose(question, {}).plan.chosen.has_value();
}

/// A route, and which of the lanes under the vehicle it begins on.
struct Found {
  RoutePlace from;
  Route route;
};

/// The cheapest one from any of those lanes; if there is none, `reason` says why.
std::optional<Found> cheapest_route(const DetourQuestion& q, const RouteOptions& options,
                                    std::string& reason) {
  Router router(q.task.road_map, options);
  std::optional<Found> best;
  reason = "the vehicle stands along no lane";
  const std::vector<RoutePlace> starts =
      places_to_set_off(q.task.road_map, q.measured.map_from_vehicle);
  for (std::size_t i = 0; i < starts.size(); ++i) {
    RouteAnswer answer = router.find(starts[i], goal_of(q.task.route));
    if (i == 0) reason = std::move(answer.reason);
    const bool is_cheaper = answer.route && (!best || answer.route->cost_s < best->route.cost_s);
    if (is_cheaper) best = Found{starts[i], *std::move(answer.route)};
  }
  return best;
}

/// The first lane of a route that another one does not use; its first where there is none.
map::LaneId first_new_lane(const Route& route, const Route& other) {
  const auto is_new = [&](const RouteLeg& leg) { return !is_on(other, leg.lane); };
  const auto found = std::ranges::find_if(route.legs, is_new);
  return found == route.legs.end() ? route.legs.front().lane : found->lane;
}

struct Effort {
  double cost_s, length_m;
};

/// Of the way that there would be if nothing was closed; where there is none from here any more, of
/// what is left of the route.
Effort effort_given_up(const DetourQuestion& q) {
  std::string reason;
  if (const auto open = cheapest_route(q, {}, reason))
    return {open->route.cost_s, open->route.length_m};
  const double driven_m = q.task.line.project(q.measured.map_from_vehicle.position()).s_m;
  const double left = std::clamp(1.0 - driven_m / q.task.line.goal_s_m(), 0.0, 1.0);
  return {left * q.task.route.cost_s, left * q.task.route.length_m};
}

Detour detour_along(const DetourQuestion& q, Found found, RouteLine line, map::LaneId by_lane) {
  const Effort given_up = effort_given_up(q);
  std::vector<StopPoint> places =
      stop_points(q.task.road_map, found.route, line.line, q.task.lights);
  Detour detour{.route = std::move(found.route),
                .line = std::move(line),
                .stop_points = std::move(places),
                .blockers = q.blockers,
                .missed = q.missed,
                .by_lane = by_lane};
  detour.longer_s = detour.route.cost_s - given_up.cost_s;
  detour.longer_m = detour.route.length_m - given_up.length_m;
  return detour;
}

}  // namespace

void Detour::lead(DrivingTask& of) const {
  of.route = route;
  of.line = line.line;
  of.line_options = line.options;
  of.other_levels = OtherLevels(of.road_map, route);
  of.stop_points = stop_points;
  of.blockers = blockers;
  of.missed = missed;
}

std::string described(const Detour& detour, const map::RoadMap& road_map) {
  return fmt::format("another route by lane {} is taken, {:.0f} m ({:+.0f} m, {:+.0f} s)",
                     road_map.lane(detour.by_lane).name, detour.route.length_m, detour.longer_m,
                     detour.longer_s);
}

std::vector<std::size_t> known_blockers(const DrivingTask& task, double t_s) {
  std::vector<std::size_t> known = task.blockers;
  std::erase_if(known, [&](std::size_t one) { return !is_standing(task.obstacles[one], t_s); });
  return known;
}

bool is_standing(const Obstacle& obstacle, double t_s) {
  constexpr double kStands_mps = 0.3;
  return obstacle.is_there(t_s) &&
         (obstacle.is_static() || std::abs(obstacle.motion.at(t_s).speed_mps) < kStands_mps);
}

std::vector<BlockedStretch> stretches_closed_by(const Obstacle& obstacle, const DetourQuestion& q) {
  const geometry::Rectangle body = rectangle_at(obstacle, q.t_s);
  const Eigen::Vector2d reach(body.radius_m(), body.radius_m());
  const double needed_m = q.vehicle.width_m + 2.0 * q.driving.clearance_m;
  std::vector<BlockedStretch> closed;
  for (const map::LaneId id : q.task.road_map.index().lanes.in_box(
           body.centre - reach, body.centre + reach, map::LaneTypes::drivable())) {
    const map::Lane& lane = q.task.road_map.lane(id);
    const TakenPart taken = part_taken(lane, body);
    if (!taken.is_on_lane) continue;
    const double half_m = 0.5 * lane.width_m(0.5 * (taken.from_s_m + taken.to_s_m));
    const double room_m = std::max(half_m - taken.left_d_m, half_m + taken.right_d_m);
    if (room_m >= needed_m && !is_on(q.task.route, id)) continue;
    const double behind_m = lane.one_way ? q.vehicle.rear_overhang_m : q.vehicle.front_m();
    closed.push_back({id,
                      {taken.from_s_m - q.vehicle.front_m() - q.driving.clearance_m,
                       taken.to_s_m + behind_m + q.driving.clearance_m}});
  }
  return closed;
}

DetourAnswer find_detour(const DetourQuestion& q) {
  RouteOptions options = options_without(q);
  std::string reason, not_joined;
  for (std::size_t tried = 0; tried < kMostTried; ++tried) {
    std::optional<Found> found = cheapest_route(q, options, reason);
    if (!found) break;
    const map::LaneId by_lane = first_new_lane(found->route, q.task.route);
    RouteLine line =
        line_along(q.task.road_map, found->route, q.vehicle, q.driving.desired_speed_mps);
    if (can_be_joined(q, line.line)) {
      return {detour_along(q, *std::move(found), std::move(line), by_lane), ""};
    }
    not_joined += (tried == 0 ? "" : ", ") + q.task.road_map.lane(by_lane).name;
    options.avoid.push_back(by_lane);
  }
  if (!not_joined.empty()) reason = "no path leads past what stands there to lane " + not_joined;
  return {{}, std::move(reason)};
}

}  // namespace roadbed::planning::behaviour
