#pragma once

// Private to tools/python: routes, and what is made of them.

#include <map>
#include <memory>
#include <mutex>
#include <string>

#include "roadbed/planning/reference/reference_line.h"
#include "roadbed/planning/route/router.h"
#include "roadbed/tools/python/bindings.h"

namespace roadbed::tools::inline python {

/// The keyword arguments of everything that asks for routes, as they stand in signatures.
#define ROADBED_ROUTE_OPTIONS                                                                   \
  "cost: typing.Literal['time', 'distance'] = 'time', participant: str = 'car', avoid: "        \
  "collections.abc.Sequence[str] = (), default_speed_mps: float = ..., max_speed_mps: float = " \
  "36.1, lateral_acceleration_mps2: float = 2.0, lane_change_cost: float = ..., "               \
  "left_turn_cost: float = 0.0, right_turn_cost: float = 0.0, u_turn_cost: float = ..., "       \
  "signal_cost: float = 0.0, least_lane_change_m: float = 10.0"

/// @throws std::invalid_argument for a value that is none, nb::type_error for another key,
///         InputError for a closed lane that is not on the map.
planning::RouteOptions route_options(const map::RoadMap& road_map, const nb::kwargs& given);

/// A route, or why there is none, and the map that it is on.
struct RouteOfMap {
  RoadMapPointer road_map;
  planning::RouteAnswer answer;
  double shared_length_fraction = 0.0;  ///< of an alternative, with those before it

  /// @throws std::invalid_argument if there is none.
  const planning::Route& route() const;
};

/// A line to drive along, in a map's frame or in one of its own.
struct LineOfMap {
  RoadMapPointer road_map;  ///< none: of way-points alone
  planning::ReferenceLine line;
  Eigen::Vector2d origin_in_source{0, 0};
};

/// Routers of a map by their options, prepared for many questions. Each is for one thread.
struct Map::Routers {
  struct Entry {
    planning::Router router;
    std::mutex mutex = {};
  };
  std::mutex mutex;
  std::map<std::string, std::shared_ptr<Entry>> by_options;
};

}  // namespace roadbed::tools::python
