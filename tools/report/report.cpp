#include "roadbed/tools/report/report.h"

namespace roadbed::tools::inline report {

LineInSource ReportLane::outline() const {
  LineInSource ring = right;
  ring.insert(ring.end(), left.rbegin(), left.rend());
  return ring;
}

std::string_view ReportLane::look() const {
  using map::LaneType;
  if (map::is_drivable(type)) return in_junction ? "junction" : "drive";
  switch (type) {
    case LaneType::none:
      return {};
    case LaneType::bus:
    case LaneType::taxi:
      return in_junction ? "junction" : "drive";
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
    default:
      return "other";
  }
}

Tone tone_of(planning::Verdict verdict) {
  if (verdict == planning::Verdict::clear) return Tone::good;
  return verdict == planning::Verdict::conflict ? Tone::bad : Tone::open;
}

}  // namespace roadbed::tools::report
