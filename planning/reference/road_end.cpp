#include "roadbed/planning/reference/road_end.h"

#include <algorithm>

namespace roadbed::planning::inline reference {
namespace {

constexpr double kAlong_m = 0.5, kHalfGap_m = 0.3, kExact_m = 1e-3;

}  // namespace

double road_end_s_m(const ReferenceLine& line, const map::RoadMap& road_map) {
  const auto is_road = [&](double s_m, double margin_m) {
    return road_map.on_surface(line.at(s_m).in_map, margin_m);
  };
  double off_m = line.goal_s_m();
  while (off_m < line.length_m() && is_road(off_m, kHalfGap_m)) off_m += kAlong_m;
  if (off_m >= line.length_m()) return line.length_m();
  double on_m = std::max(0.0, off_m - kAlong_m - kHalfGap_m);
  while (off_m - on_m > kExact_m) {
    const double middle_m = 0.5 * (on_m + off_m);
    (is_road(middle_m, kExact_m) ? on_m : off_m) = middle_m;
  }
  return on_m;
}

}  // namespace roadbed::planning::reference
