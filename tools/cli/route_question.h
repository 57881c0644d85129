#pragma once

#include <optional>
#include <string>
#include <vector>

#include "roadbed/planning/route/route_options.h"
#include "roadbed/tools/cli/arguments.h"
#include "roadbed/tools/cli/place.h"

namespace roadbed::tools::inline cli {

/// What is wrong with the writing of what is closed: lane:NAME, road:ID or polygon:X,Y,X,Y,X,Y;
/// empty if nothing is. Needs no map.
std::string avoid_fault(const std::string& text);

/// The lanes that are closed by a text without a fault.
/// @throws InputError for a lane or road that is not on the map.
std::vector<map::LaneId> closed_by(const map::RoadMap& road_map, const std::string& text);

/// The options that say how a route is judged: `--cost --avoid --participant` and prices.
class RouteRules {
 public:
  /// @param with_cost  with the measure itself; else `on` is told it.
  /// @returns what was declared.
  std::vector<Argument> declare(Arguments& arguments, bool with_cost = true);

  /// @throws InputError for a lane or road that is not on the map.
  planning::RouteOptions on(const map::RoadMap& road_map,
                            std::optional<planning::RouteCost> measure = {}) const;

  map::Participant participant() const { return participant_; }

 private:
  std::vector<Argument> declare_speeds(Arguments& arguments);
  std::vector<Argument> declare_prices(Arguments& arguments);

  planning::RouteCost cost_ = planning::RouteCost::time;
  map::Participant participant_ = map::Participant::car;
  std::vector<std::string> avoid_;
  std::optional<double> default_speed_kmh_, max_speed_kmh_, lateral_mps2_;
  std::optional<double> lane_change_, left_turn_, right_turn_, u_turn_, signal_;
  std::optional<double> least_lane_change_m_;
};

/// Those and the places: `--from --via --to`.
class RouteQuestion {
 public:
  /// @param with_batch  start and goal may be missing, since a file names them.
  /// @returns the rules that were declared.
  std::vector<Argument> declare(Arguments& arguments, bool with_batch = false);

  /// What they ask for on a map.
  struct Asked {
    Place from, to;
    std::vector<Place> via;
    planning::RouteOptions options;

    /// Start, places between, goal.
    std::vector<planning::RoutePlace> places() const;
  };

  /// @throws InputError for a place or lane that is not on the map.
  Asked on(const map::RoadMap& road_map) const;

  const RouteRules& rules() const { return rules_; }
  bool has_places() const { return !from_.empty() && !to_.empty(); }
  bool has_any_place() const { return !from_.empty() || !to_.empty() || !via_.empty(); }
  bool has_via() const { return !via_.empty(); }

 private:
  std::string from_, to_;
  std::vector<std::string> via_;
  RouteRules rules_;
};

}  // namespace roadbed::tools::cli
