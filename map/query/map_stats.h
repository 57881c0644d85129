#pragma once

#include <cstddef>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "roadbed/map/model/road_map.h"

namespace roadbed::map::inline query {

/// What lanes, or parts of lanes, amount to.
struct StatsRow {
  std::string value;  ///< "driving", "50"; empty in a class from … to
  double from = 0.0;  ///< of a class, its own
  double to = std::numeric_limits<double>::infinity();  ///< of a class, no more its own
  std::size_t lanes = 0;                                ///< with a part here
  double length_m = 0.0;                                ///< of their centrelines
  double area_m2 = 0.0;  ///< between their borders; where lanes lie on each other each counts
};

/// Rows by one property of lanes. Over all rows, lengths and areas are those of all lanes.
struct StatsTable {
  std::string_view by;    ///< "type", "speed", "width", "slope", "curvature"
  std::string_view unit;  ///< "km/h", "m", "%", "1/m"; empty if there is none
  bool has_classes = false;
  std::vector<StatsRow> rows;  ///< without those of no lane
};

struct MapStats {
  StatsRow all;
  std::vector<StatsTable> tables;
};

/// Lengths and areas of lanes by their type and speed limit, and along each lane by width, slope
/// and curvature (the last two without their sign). O(N log N) for N vertices.
MapStats map_stats(const RoadMap& road_map, std::span<const LaneId> lanes);

}  // namespace roadbed::map::query
