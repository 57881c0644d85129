#pragma once

#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "roadbed/map/model/road_map.h"
#include "roadbed/planning/route/route_network.h"
#include "roadbed/planning/route/route_options.h"
#include "roadbed/planning/route/route_place.h"

namespace roadbed::planning::inline route {

class ObstacleFinder;
class RouteSolver;
struct Way;

/// How a leg of a route is left.
enum class LegExit { goal, successor, change_left, change_right };

/// A stretch of one lane. Where it is left to a neighbour, `to_s_m` is the middle of what the
/// change has of this lane. A lane of both directions may be driven against its own: then stations
/// fall, those of the window, too.
struct RouteLeg {
  map::LaneId lane;
  bool reversed = false;
  double from_s_m = 0.0;
  double to_s_m = 0.0;
  LegExit exit = LegExit::goal;
  Turn turn = Turn::none;  ///< of the lane
  /// Stations of the lane between which the change is made by which the leg is left: below 0, or
  /// above its length, where it begins beside a lane before or ends beside one behind.
  std::optional<map::StationRange> change_window;
  double length_m = 0.0;  ///< along the last lane of the passage, so that lengths add up
  double cost_s = 0.0;    ///< of this leg, with the change that leaves it and the turn that it is
  double cost_m = 0.0;
  bool limit_known = true;  ///< everywhere on the lane
};

/// A place that a route was to pass.
struct RouteStop {
  std::size_t leg = 0;
  double s_m = 0.0;  ///< station of that leg's lane
};

struct Route {
  std::vector<RouteLeg> legs;
  double cost_s = 0.0;    ///< travel time at the limits, and manoeuvres: the sum of the legs'
  double cost_m = 0.0;    ///< length, and manoeuvres: the sum of the legs'
  double length_m = 0.0;  ///< along the centrelines; parallel lanes count once, as the last of them
  int lane_changes = 0;
  int legs_of_unknown_speed = 0;
  std::vector<RouteStop> stops;  ///< the places between start and goal, in order
};

/// What keeps a route from being found.
enum class Barrier { closed, length, marking, participant, one_way, map_gap };
std::string_view name(Barrier barrier);

/// What stands between a start and a goal that no route connects.
struct RouteObstacle {
  std::size_t lanes_from_start = 0;  ///< that can be reached
  std::size_t lanes_to_goal = 0;     ///< from which the goal can be reached
  double gap_m = 0.0;                ///< least distance from an end of those to a start of these
  std::optional<map::LaneId> gap_from, gap_to;
  /// A least set of rules without which there would be a route; just `map_gap` if there is none
  /// even without all of them.
  std::vector<Barrier> barriers;
  /// Where the route that would be there then leaves the lanes that can be reached.
  std::optional<map::LaneId> blocked_from, blocked_to;
};

/// A route, or why there is none.
struct RouteAnswer {
  std::optional<Route> route;
  std::string reason;                     ///< one line; empty if there is a route
  std::optional<RouteObstacle> obstacle;  ///< none if start or goal themselves are unfit
  std::size_t failed_part = 0;            ///< between which two places there is no route, from 0
};

/// Routes of one map by one set of options: prepared once, asked many times. For one thread.
///
/// Between two section ends, parallel lanes form one passage: it is driven along its share of each
/// lane. Changes are made within the stations where the marking permits them, each in a range of
/// its own that is as long as all of them can have, and `least_lane_change_m` at least; with less
/// than `comfortable_lane_change_m` they cost more in proportion. A passage costs what its last
/// lane costs. Closed lanes are used nowhere. Costs are compared to 0.1 ms or 1 mm an arc; of
/// equally cheap routes the one with the lower lane ids is taken.
///
/// Where a passage is shorter than that, a change may begin in it and end in a following one, as
/// long as both lanes stay neighbours across the section ends between, see ChangeSpan. Up to the
/// middle of such a change passages cost what the lane that is left costs.
///
/// A* is guided by the straight-line distance times the least cost per metre that any link of the
/// map has, so that it is right on maps with gaps, too.
class Router {
 public:
  /// Refers to the map. O(points of the map).
  /// @throws std::invalid_argument if a closed lane is not in the map.
  explicit Router(const map::RoadMap& road_map, RouteOptions options = {});
  ~Router();
  Router(Router&&) noexcept;
  Router& operator=(Router&&) noexcept;

  /// Builds a hierarchy, by which find() then searches: for many questions. Of routes that cost the
  /// same it may take another one.
  void prepare();

  /// @throws std::invalid_argument if a lane is not in the map or a station not on its lane.
  RouteAnswer find(const RoutePlace& from, const RoutePlace& to);

  /// From the first place over all others in their order to the last one. Loops are allowed; a
  /// place that is passed twice counts in its turn. No vehicle turns round at a place.
  /// @throws std::invalid_argument also if there are fewer than two places.
  RouteAnswer find(std::span<const RoutePlace> places);

  /// A route of a way that was found elsewhere for the same options.
  Route route_along(const Way& way) const;

  /// Whether the place can be part of a route.
  bool is_fit(const map::LanePlace& place) const;

  /// Why it cannot; empty if it can.
  std::string unfit(const map::LanePlace& place, const std::string& what) const;

  const map::RoadMap& road_map() const { return *road_map_; }
  const RouteOptions& options() const { return options_; }
  RouteSolver& solver() { return *solver_; }

 private:
  struct Measures;
  RouteAnswer refusal(std::span<const RoutePlace> places, const RoutePlace& from, std::size_t part);
  Route lay_out(const std::vector<Way>& ways) const;

  const map::RoadMap* road_map_;
  RouteOptions options_;
  std::unique_ptr<RouteSolver> solver_;
  std::unique_ptr<const Measures> measures_;
  std::unique_ptr<ObstacleFinder> obstacles_;
};

/// One question to a router that nobody needs again.
RouteAnswer find_route(const map::RoadMap& road_map, const RoutePlace& from, const RoutePlace& to,
                       const RouteOptions& options = {});

}  // namespace roadbed::planning::route
