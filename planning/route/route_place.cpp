#include "roadbed/planning/route/route_place.h"

namespace roadbed::planning::inline route {

std::vector<NetworkPlace> ways_through(const RouteNetwork& network, const RoutePlace& place) {
  const std::uint32_t lane = place.lane.index, twin = network.lanes[lane].twin;
  std::vector<NetworkPlace> ways;
  if (place.sense != Sense::against || twin == kNoLane) ways.push_back({lane, place.s_m});
  if (place.sense != Sense::along && twin != kNoLane) {
    ways.push_back({twin, network.lanes[lane].length_m - place.s_m});
  }
  return ways;
}

}  // namespace roadbed::planning::route
