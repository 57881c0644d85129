#include "roadbed/planning/behaviour/route_line.h"

#include <algorithm>
#include <utility>

#include "roadbed/planning/maneuvers/merge_places.h"

namespace roadbed::planning::inline behaviour {

RouteLine line_along(const map::RoadMap& road_map, const Route& route,
                     const geometry::VehicleShape& vehicle, double desired_speed_mps) {
  constexpr double kChange_s = 3.5;
  ReferenceLineOptions options{.corner_vehicle = vehicle};
  ReferenceLine line = ReferenceLine::along(road_map, route, options);
  double fastest_mps = 0.0;
  for (const MergePlace& place : merge_places(road_map, route, line)) {
    fastest_mps = std::max(fastest_mps, line.corridor_at(place.enter_s_m).speed_limit_mps);
  }
  const double length_m = kChange_s * std::min(fastest_mps, desired_speed_mps);
  if (length_m > options.lane_change_length_m) {
    options.lane_change_length_m = length_m;
    line = ReferenceLine::along(road_map, route, options);
  }
  return {std::move(line), options};
}

}  // namespace roadbed::planning::behaviour
