#include "roadbed/map/elements/lane_bend.h"

#include <algorithm>
#include <cmath>

#include "roadbed/geometry/primitives/angle.h"

namespace roadbed::map::inline elements {
namespace {

constexpr double kEndChord_m = 1.0;

double heading_between(const geometry::Polyline& line, double from_m, double to_m) {
  const Eigen::Vector2d along = line.at(to_m) - line.at(from_m);
  return std::atan2(along.y(), along.x());
}

}  // namespace

double bend_rad(const Lane& lane) {
  const auto& line = lane.centre.in_map;
  const double chord_m = std::min(kEndChord_m, 0.5 * line.length_m());
  return geometry::wrap_angle(heading_between(line, line.length_m() - chord_m, line.length_m()) -
                              heading_between(line, 0.0, chord_m));
}

}  // namespace roadbed::map::elements
