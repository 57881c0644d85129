#pragma once

#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "roadbed/map/model/road_map.h"
#include "roadbed/planning/route/no_route_explanation.h"
#include "roadbed/planning/route/route.h"
#include "roadbed/planning/route/route_options.h"
#include "roadbed/planning/route/route_place.h"

namespace roadbed::planning::inline route {

class RouteSolver;
struct Way;

/// A route, or why there is none.
struct RouteAnswer {
  std::optional<Route> route;
  std::string reason;                             ///< one line; empty if there is a route
  std::optional<NoRouteExplanation> explanation;  ///< none if start or goal themselves are unfit
  std::size_t failed_part = 0;  ///< between which two places there is no route, from 0
};

/// Routes of one map by one set of options: prepared once, asked many times. For one thread.
///
/// Between two section ends, parallel lanes form one lane group: it is driven along its share of
/// each lane. Changes are made within the stations where the marking permits them, each in a range
/// of its own that is as long as all of them can have, and `least_lane_change_m` at least; with
/// less than `comfortable_lane_change_m` they cost more in proportion. A lane group costs what its
/// last lane costs. Closed lanes are used nowhere. Costs are compared to 0.1 ms or 1 mm an arc; of
/// equally cheap routes the one with the lower lane ids is taken.
///
/// Where a lane group is shorter than that, a change may begin in it and end in a following one, as
/// long as both lanes stay neighbours across the section ends between, see ChangeSpan. Up to the
/// middle of such a change lane groups cost what the lane that is left costs.
///
/// A* is guided by the straight-line distance times the least cost per metre that any link of the
/// map has, so that it is right on maps with gaps, too.
class Router {
 public:
  /// Refers to the map. O(points of the map).
  /// @throws std::invalid_argument if a closed or blocked lane is not in the map.
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

  /// Whether the place can be part of a route, on any of its lanes.
  bool is_fit(const RoutePlace& place) const;

  /// Why it cannot; empty if it can.
  std::string unfit(const RoutePlace& place, const std::string& what) const;

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
  std::unique_ptr<NoRouteExplainer> explainer_;
};

/// One question to a router that nobody needs again.
RouteAnswer find_route(const map::RoadMap& road_map, const RoutePlace& from, const RoutePlace& to,
                       const RouteOptions& options = {});

}  // namespace roadbed::planning::route
