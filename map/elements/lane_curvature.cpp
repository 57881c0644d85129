#include "roadbed/map/elements/lane_curvature.h"

#include <algorithm>
#include <cmath>

#include "roadbed/geometry/primitives/cross.h"

namespace roadbed::map::inline elements {
namespace {

using Eigen::Vector2d;

// The middle of an arc of length L that turns by θ is L θ / 8 off its chord.
constexpr double kDrawnTo_m = 0.25;
constexpr double kSameStation_m = 1e-6;

/// Of the segment at a station; at a vertex the mean of the two that meet there.
double spacing_m(const LaneLine& line, double s_m) {
  const auto& stations_m = line.station_m;
  auto before = std::ranges::lower_bound(stations_m, s_m - kSameStation_m);
  auto after = std::ranges::upper_bound(stations_m, s_m + kSameStation_m);
  if (before == stations_m.begin() || after == stations_m.end()) return 0.0;
  const bool is_vertex = before != after;
  return (*after - *--before) / (is_vertex ? 2.0 : 1.0);
}

}  // namespace

double curvature_about_per_m(const Lane& lane, double s_m, double chord_m) {
  if (!(std::min(s_m, lane.length_m() - s_m) >= chord_m)) return 0.0;
  double drawn_m = chord_m;
  for (const LaneLine* line : {&lane.left, &lane.centre, &lane.right}) {
    drawn_m = std::max(drawn_m, spacing_m(*line, s_m));
  }
  const auto& line = lane.centre.in_map;
  const Vector2d middle = line.at(s_m);
  const Vector2d before = middle - line.at(s_m - chord_m), after = line.at(s_m + chord_m) - middle;
  const double turn_rad = std::atan2(geometry::cross(before, after), before.dot(after));
  const double stood_for_m = 8.0 * kDrawnTo_m / std::max(std::abs(turn_rad), 1e-9);
  return turn_rad / std::max(chord_m, std::min(drawn_m, stood_for_m));
}

}  // namespace roadbed::map::elements
