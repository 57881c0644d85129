#include "roadbed/tools/report/lane_look.h"

namespace roadbed::tools::inline report {

std::string_view lane_look(const ReportLane& lane) {
  using map::LaneType;
  switch (lane.type) {
    case LaneType::none:
      return {};
    case LaneType::driving:
    case LaneType::bidirectional:
    case LaneType::entry:
    case LaneType::exit:
    case LaneType::on_ramp:
    case LaneType::off_ramp:
    case LaneType::connecting_ramp:
    case LaneType::bus:
    case LaneType::taxi:
      return lane.in_junction ? "junction" : "drive";
    case LaneType::shoulder:
    case LaneType::stop:
    case LaneType::parking:
    case LaneType::border:
      return "shoulder";
    case LaneType::sidewalk:
    case LaneType::curb:
    case LaneType::median:
      return "walk";
    case LaneType::biking:
      return "bike";
    case LaneType::restricted:
    case LaneType::roadworks:
    case LaneType::tram:
    case LaneType::rail:
    case LaneType::other:
      return "other";
  }
  return "other";
}

}  // namespace roadbed::tools
