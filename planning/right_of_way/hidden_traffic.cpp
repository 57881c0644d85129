#include "roadbed/planning/right_of_way/hidden_traffic.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <set>
#include <utility>

#include "roadbed/map/derived/conflicts.h"
#include "roadbed/map/derived/lane_relations.h"
#include "roadbed/map/derived/rule_index.h"
#include "roadbed/planning/task/give_way_rules.h"

namespace roadbed::planning::inline right_of_way {
namespace {

using map::LaneId;

constexpr double kUpstream_m = 200.0;  // looked at
constexpr double kLimitIfUnknown_mps = 50.0 / 3.6;
constexpr double kLookStep_m = 2.5, kHiddenCar_m = 5.0, kHiddenCarWidth_m = 1.8;
constexpr double kComesFor_s = 12.0, kComesStep_s = 0.5;
constexpr std::size_t kMostApproaches = 16;

/// One that drives along a way from a place on, straight on past its end.
geometry::Trajectory coming_along(const geometry::Polyline& way, double from_s_m, double speed_mps,
                                  double t_s) {
  std::vector<geometry::TrajectoryPoint> points;
  for (double after_s = 0.0; after_s <= kComesFor_s; after_s += kComesStep_s) {
    const double s_m = from_s_m + speed_mps * after_s;
    const double over_m = std::max(0.0, s_m - way.length_m());
    const geometry::Pose2 pose = way.pose_at(s_m) * geometry::Pose2{over_m, 0.0, 0.0};
    points.push_back({.t_s = t_s + after_s,
                      .x_m = pose.x_m,
                      .y_m = pose.y_m,
                      .heading_rad = pose.heading_rad,
                      .speed_mps = speed_mps});
  }
  return geometry::Trajectory(std::move(points));
}

}  // namespace

class HiddenTraffic::Finder {
 public:
  Finder(const DrivingTask& task, const StopPoint& place) : task_(task), place_(place) {
    for (const RouteLeg& leg : task.route.legs) on_route_.insert(leg.lane);
  }

  std::vector<Approach> find() {
    for (const RouteLeg& leg : task_.route.legs) {
      if (!leg.reversed && is_within(leg)) add_all(leg);
    }
    return std::move(found_);
  }

 private:
  double station(LaneId lane, double s_m) const {
    return task_.line.project(task_.road_map.lane(lane).pose_at(s_m).position(), place_.s_m).s_m;
  }

  bool is_within(const RouteLeg& leg) const {
    return station(leg.lane, leg.to_s_m) > place_.s_m &&
           station(leg.lane, leg.from_s_m) < place_.clear_s_m;
  }

  void add_all(const RouteLeg& leg) {
    for (const map::Conflict& conflict : map::find_conflicts_of(task_.road_map, leg.lane)) {
      if (conflict.kind == map::ConflictKind::diverging) continue;
      const LaneId other = conflict.partner_of(leg.lane);
      const double meets_at_m = station(leg.lane, conflict.on(leg.lane).from_s_m);
      if (on_route_.contains(other) || meets_at_m < place_.s_m) continue;
      if (place_.kind == StopKind::turn && !map::begin_oppositely(task_.road_map, leg.lane, other))
        continue;
      add(other, conflict.on(other).from_s_m, meets_at_m);
    }
  }

  /// A lane, and each way on which one comes to it.
  void add(LaneId lane, double meets_at_m, double in_the_way_from_m) {
    const map::Lane& meets = task_.road_map.lane(lane);
    if (!map::is_drivable(meets.type) || gives_way(lane)) return;
    extend(lane, {.way = meets.centre.in_map,
                  .meets_at_m = meets_at_m,
                  .in_the_way_from_m = in_the_way_from_m,
                  .limit_mps = meets.least_speed_limit_mps().value_or(0.0),
                  .lane = meets.name});
  }

  void extend(LaneId from, Approach approach) {
    std::vector<LaneId> before;
    for (const LaneId lane : task_.road_map.graph().of(from).predecessors) {
      if (map::is_drivable(task_.road_map.lane(lane).type)) before.push_back(lane);
    }
    if (found_.size() >= kMostApproaches) return;
    if (before.empty() || approach.meets_at_m >= kUpstream_m) {
      found_.push_back(std::move(approach));
      return;
    }
    for (const LaneId lane : before) {
      if (on_route_.contains(lane) || gives_way(lane)) continue;
      const map::Lane& comes_from = task_.road_map.lane(lane);
      std::vector<Eigen::Vector2d> points = comes_from.centre.in_map.points();
      points.insert(points.end(), approach.way.points().begin(), approach.way.points().end());
      Approach longer = approach;
      longer.way = geometry::Polyline(std::move(points));
      longer.meets_at_m += longer.way.length_m() - approach.way.length_m();
      longer.limit_mps =
          std::max(longer.limit_mps, comes_from.least_speed_limit_mps().value_or(0.0));
      extend(lane, std::move(longer));
    }
  }

  /// By a sign or a regulation.
  bool gives_way(LaneId lane) const {
    const map::RoadMap& road_map = task_.road_map;
    const std::array<LaneId, 1> one{lane};
    const map::RuleIndex rules(road_map, one);
    const auto yields_by = [&](std::size_t index) {
      return has_priority_role(road_map.regulations()[index], "yield", lane);
    };
    return has_sign_to_give_way(road_map, rules, lane) ||
           std::ranges::any_of(rules.at(lane, 0.0).regulations, yields_by);
  }

  const DrivingTask& task_;
  const StopPoint& place_;
  std::set<LaneId> on_route_;
  std::vector<Approach> found_;
};

const std::vector<HiddenTraffic::Approach>& HiddenTraffic::approaches_to(std::size_t stop_point) {
  const auto known = approaches_.find(stop_point);
  if (known != approaches_.end()) return known->second;
  Finder finder(task_, task_.stop_points[stop_point]);
  return approaches_.emplace(stop_point, finder.find()).first->second;
}

HiddenTraffic::MayCome HiddenTraffic::towards(std::size_t stop_point, const Visibility& sight,
                                              double t_s) {
  MayCome found;
  for (const Approach& approach : approaches_to(stop_point)) {
    add_hidden(approach, sight, t_s, found);
  }
  return found;
}

/// Car by car upstream; behind who is seen on the way nobody can come before that one.
void HiddenTraffic::add_hidden(const Approach& approach, const Visibility& sight, double t_s,
                               MayCome& found) {
  const double limit_mps = approach.limit_mps > 0.0 ? approach.limit_mps : kLimitIfUnknown_mps;
  const double until_m = std::max(0.0, approach.meets_at_m - kUpstream_m);
  double hidden_m = 0.0;
  for (double s_m = approach.meets_at_m; s_m > until_m; s_m -= kLookStep_m) {
    const Eigen::Vector2d point = approach.way.pose_at(s_m).position();
    if (sight.is_on_body(point)) return;
    hidden_m = sight.sees(point) ? 0.0 : hidden_m + kLookStep_m;
    if (hidden_m < kHiddenCar_m) continue;
    hidden_m = 0.0;
    const double from_s_m = s_m + 0.5 * (kHiddenCar_m - kLookStep_m);  // of its middle
    found.in_the_way_from_m.push_back(approach.in_the_way_from_m);
    found.cars.push_back({.id = fmt::format("on lane {}, {:.0f} m before the route", approach.lane,
                                            approach.meets_at_m - from_s_m - 0.5 * kHiddenCar_m),
                          .kind = "somebody hidden",
                          .length_m = kHiddenCar_m,
                          .width_m = kHiddenCarWidth_m,
                          .motion = coming_along(approach.way, from_s_m, limit_mps, t_s)});
  }
}

}  // namespace roadbed::planning::right_of_way
