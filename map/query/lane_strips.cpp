#include "roadbed/map/query/lane_strips.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "roadbed/geometry/primitives/cross.h"
#include "roadbed/map/elements/lane_curvature.h"

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

/// At each station; at the lane's ends that of their neighbours.
std::vector<double> curvatures_per_m(const Lane& lane, const std::vector<double>& stations_m) {
  const double chord_m = std::min(kChord_m, 0.25 * lane.length_m());
  std::vector<double> curvatures(stations_m.size(), 0.0);
  if (!(chord_m > 0.0)) return curvatures;
  for (std::size_t i = 0; i < stations_m.size(); ++i) {
    const double s_m = std::clamp(stations_m[i], chord_m, lane.length_m() - chord_m);
    curvatures[i] = curvature_about_per_m(lane, s_m, chord_m);
  }
  if (curvatures.size() > 2) {
    curvatures.front() = curvatures[1];
    curvatures.back() = curvatures[curvatures.size() - 2];
  }
  return curvatures;
}

/// Of the centreline from each station to the next.
std::vector<Vector2d> directions(const Lane& lane, const std::vector<double>& stations_m) {
  std::vector<Vector2d> steps;
  for (std::size_t i = 1; i < stations_m.size(); ++i) {
    const auto& line = lane.centre.in_map;
    steps.push_back((line.at(stations_m[i]) - line.at(stations_m[i - 1])).normalized());
  }
  return steps;
}

/// Across the centreline. A road's borders are sampled in its cross-sections; those of other lanes
/// have their points anywhere, so that two of one station may lie far apart along the lane.
double width_m(const Lane& lane, double s_m, const Vector2d& along) {
  const double between_m = lane.width_m(s_m);
  if (lane.road || along.squaredNorm() == 0.0) return between_m;
  const Vector2d across = Lane::point_at(lane.left, s_m) - Lane::point_at(lane.right, s_m);
  return std::copysign(std::abs(geometry::cross(along.normalized(), across)), between_m);
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
  const std::vector<double> curvatures = curvatures_per_m(lane, stations_m);
  const std::vector<Vector2d> steps = directions(lane, stations_m);
  std::vector<LaneStrip> strips;
  double end_width_m = width_m(lane, 0.0, steps.empty() ? Vector2d::Zero() : steps.front());
  for (std::size_t i = 1; i < stations_m.size(); ++i) {
    LaneStrip strip;
    strip.from_s_m = stations_m[i - 1];
    strip.to_s_m = stations_m[i];
    const double middle_m = 0.5 * (strip.from_s_m + strip.to_s_m);
    const Vector2d& step = steps[i - 1];
    strip.area_m2 = quadrangle_m2(lane, strip.from_s_m, strip.to_s_m);
    strip.width_m = width_m(lane, middle_m, step);
    strip.start_width_m = end_width_m;
    strip.end_width_m = end_width_m =
        width_m(lane, strip.to_s_m, i < steps.size() ? Vector2d(step + steps[i]) : step);
    strip.slope = (height_m(lane.centre, strip.to_s_m) - height_m(lane.centre, strip.from_s_m)) /
                  strip.length_m();
    const double start = curvatures[i - 1], end = curvatures[i];
    strip.curvature_per_m = std::abs(start) > std::abs(end) ? start : end;
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
  for (const LaneStrip& strip : lane_strips(lane)) {
    measures.area_m2 += strip.area_m2;
    add_width(strip.start_width_m);
    add_width(strip.end_width_m);
    measures.greatest_slope = std::max(measures.greatest_slope, std::abs(strip.slope));
    measures.greatest_curvature_per_m =
        std::max(measures.greatest_curvature_per_m, std::abs(strip.curvature_per_m));
  }
  measures.mean_width_m = measures.area_m2 / lane.length_m();
  return measures;
}

}  // namespace roadbed::map::query
