#include "roadbed/planning/route/route_options.h"

#include <algorithm>
#include <array>

namespace roadbed::planning::inline route {

double enough_room_m(const RouteOptions& options) {
  return std::max(options.comfortable_lane_change_m, options.least_lane_change_m);
}

double default_speed_mps(map::LaneType type) {
  switch (type) {
    case map::LaneType::driving:
    case map::LaneType::bus:
    case map::LaneType::taxi:
    case map::LaneType::tram:
    case map::LaneType::rail:
      return 50.0 / 3.6;
    case map::LaneType::entry:
    case map::LaneType::exit:
    case map::LaneType::on_ramp:
    case map::LaneType::off_ramp:
    case map::LaneType::connecting_ramp:
      return 60.0 / 3.6;
    case map::LaneType::bidirectional:
      return 30.0 / 3.6;
    case map::LaneType::biking:
      return 20.0 / 3.6;
    case map::LaneType::sidewalk:
      return 5.0 / 3.6;
    default:
      return 10.0 / 3.6;
  }
}

std::string_view name(map::Participant kind) {
  static constexpr std::array<std::string_view, 10> names = {
      "pedestrian", "bicycle", "motorcycle", "car",  "taxi",
      "bus",        "truck",   "emergency",  "tram", "train"};
  return names.at(static_cast<std::size_t>(kind));
}

}  // namespace roadbed::planning::route
