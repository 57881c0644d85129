#pragma once

#include <string>
#include <vector>

#include "roadbed/planning/route.h"
#include "roadbed/tools/support/arguments.h"
#include "roadbed/tools/support/place.h"

namespace roadbed::tools {

/// The options `--from --to --avoid --cost` of commands that look for a route.
class RouteQuestion {
 public:
  void declare(Arguments& arguments);

  /// What they ask for on a map.
  struct Asked {
    Place from, to;
    planning::RouteOptions options;
  };

  /// @throws InputError for a place or lane that is not on the map.
  Asked on(const map::RoadMap& road_map) const;

 private:
  std::string from_, to_;
  std::vector<std::string> avoid_;
  planning::RouteCost cost_ = planning::RouteCost::time;
};

}  // namespace roadbed::tools
