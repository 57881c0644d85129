#include "roadbed/map/query/lane_strips.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "roadbed/geometry/primitives/cross.h"

namespace roadbed::map::inline query {
namespace {

using Eigen::Vector2d;

constexpr double kChord_m = 1.0;
constexpr double kSameStation_m = 1e-6;  // between nearer ones a slope would be rounding

std::vector<double> all_stations_m(const Lane& lane) {
  std::vector<double> stations_m;
  for (const LaneLine* line : {&lane.left, &lane.centre, &lane.right}) {
    stations_m.insert(stations_m.end(), line->station_m.begin(), line->station_m.end());
  }
  std::sort(stations_m.begin(), stations_m.end());
  const double end_m = stations_m.back();
  const auto coincide = [](double a, double b) { return b - a < kSameStation_m; };
  stations_m.erase(std::unique(stations_m.begin(), stations_m.end(), coincide), stations_m.end());
  stations_m.back() = end_m;
  return stations_m;
}

double height_m(const LaneLine& line, double s_m) {
  const auto after = std::upper_bound(line.station_m.begin(), line.station_m.end(), s_m);
  if (after == line.station_m.begin()) return line.z_m.front();
  if (after == line.station_m.end()) return line.z_m.back();
  const auto i = static_cast<std::size_t>(after - line.station_m.begin());
  const double step_m = line.station_m[i] - line.station_m[i - 1];
  const double part = (s_m - line.station_m[i - 1]) / step_m;
  return line.z_m[i - 1] + part * (line.z_m[i] - line.z_m[i - 1]);
}

/// By the turn between two chords, which are shorter than a metre on a lane of less than two.
double curvature_per_m(const Lane& lane, double s_m) {
  const double chord_m = std::min(kChord_m, 0.5 * lane.length_m());
  if (!(chord_m > 0.0)) return 0.0;
  const double middle_m = std::clamp(s_m, chord_m, lane.length_m() - chord_m);
  const auto& line = lane.centre.in_map;
  const Vector2d before = line.at(middle_m) - line.at(middle_m - chord_m);
  const Vector2d after = line.at(middle_m + chord_m) - line.at(middle_m);
  return std::atan2(geometry::cross(before, after), before.dot(after)) / chord_m;
}

/// Shoelace over the four corners, counter-clockwise from the right one of the first end.
double quadrangle_m2(const Lane& lane, double from_s_m, double to_s_m) {
  const Vector2d a = Lane::point_at(lane.right, from_s_m), b = Lane::point_at(lane.right, to_s_m);
  const Vector2d c = Lane::point_at(lane.left, to_s_m), d = Lane::point_at(lane.left, from_s_m);
  return 0.5 * geometry::cross(c - a, d - b);
}

}  // namespace

std::vector<LaneStrip> lane_strips(const Lane& lane) {
  const std::vector<double> stations_m = all_stations_m(lane);
  std::vector<LaneStrip> strips;
  for (std::size_t i = 1; i < stations_m.size(); ++i) {
    LaneStrip strip;
    strip.from_s_m = stations_m[i - 1];
    strip.to_s_m = stations_m[i];
    const double middle_m = 0.5 * (strip.from_s_m + strip.to_s_m);
    strip.area_m2 = quadrangle_m2(lane, strip.from_s_m, strip.to_s_m);
    strip.width_m = lane.width_m(middle_m);
    strip.slope = (height_m(lane.centre, strip.to_s_m) - height_m(lane.centre, strip.from_s_m)) /
                  strip.length_m();
    strip.curvature_per_m = curvature_per_m(lane, middle_m);
    strips.push_back(strip);
  }
  return strips;
}

LaneMeasures measure(const Lane& lane) {
  LaneMeasures measures;
  measures.least_width_m = std::numeric_limits<double>::infinity();
  const auto add_width = [&](double width_m) {
    measures.least_width_m = std::min(measures.least_width_m, width_m);
    measures.greatest_width_m = std::max(measures.greatest_width_m, width_m);
  };
  add_width(lane.width_m(0.0));
  for (const LaneStrip& strip : lane_strips(lane)) {
    measures.area_m2 += strip.area_m2;
    add_width(lane.width_m(strip.to_s_m));
    measures.greatest_slope = std::max(measures.greatest_slope, std::abs(strip.slope));
    measures.greatest_curvature_per_m =
        std::max(measures.greatest_curvature_per_m, std::abs(strip.curvature_per_m));
  }
  measures.mean_width_m = measures.area_m2 / lane.length_m();
  return measures;
}

}  // namespace roadbed::map::query
