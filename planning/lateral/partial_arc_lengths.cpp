#include "roadbed/planning/lateral/candidate_evaluator.h"

#include <algorithm>
#include <cmath>

#include "roadbed/geometry/primitives/instruction_sets.h"

namespace roadbed::planning::inline lateral {
namespace {

double value(const std::array<double, 6>& c, double l) {
  return c[0] + l * (c[1] + l * (c[2] + l * (c[3] + l * (c[4] + l * c[5]))));
}

double slope(const std::array<double, 6>& c, double l) {
  return c[1] + l * (2.0 * c[2] + l * (3.0 * c[3] + l * (4.0 * c[4] + l * 5.0 * c[5])));
}

LinearPoint linear_point(const Station& station, const QuinticFamily& family) {
  const auto& zero = family.at_zero.coefficients();
  const auto& unit = family.per_unit.coefficients();
  const double l = station.l_m, curvature = station.line.curvature_per_m;
  const double d_zero = value(zero, l), d_unit = value(unit, l);
  return {.d_m = {d_zero, d_unit},
          .along = {1.0 - curvature * d_zero, -curvature * d_unit},
          .across = {slope(zero, l), slope(unit, l)},
          .seconds_before = 0.0,
          .metres_before = 0.0};
}

// Each section counts by the mean of the stretches at its ends.
ROADBED_CLONES void add_stretches(const LinearPoint* points, std::size_t count,
                                  const double* __restrict end_d_m,
                                  PartialArcLengths& __restrict lengths) {
  double duration_s[kSimdWidth] = {}, driven_m[kSimdWidth] = {};
  for (std::size_t station = 0; station < count; ++station) {
    const LinearPoint& p = points[station];
    const bool is_last = station + 1 == count;
    const double seconds = p.seconds_before + (is_last ? 0.0 : points[station + 1].seconds_before);
    const double metres = p.metres_before + (is_last ? 0.0 : points[station + 1].metres_before);
    for (std::size_t i = 0; i < kSimdWidth; ++i) {
      const double along = p.along[0] + end_d_m[i] * p.along[1];
      const double across = p.across[0] + end_d_m[i] * p.across[1];
      const double stretch = std::sqrt(along * along + across * across);
      duration_s[i] += seconds * stretch;
      driven_m[i] += metres * stretch;
    }
  }
  for (std::size_t i = 0; i < kSimdWidth; ++i) {
    lengths.duration_s[i] = duration_s[i];
    lengths.driven_m[i] = driven_m[i];
  }
}

}  // namespace

std::vector<LinearPoint> linear_points(const std::vector<Station>& stations,
                                       const QuinticFamily& family) {
  std::vector<LinearPoint> points;
  points.reserve(stations.size());
  for (std::size_t i = 0; i < stations.size(); ++i) {
    points.push_back(linear_point(stations[i], family));
    if (i == 0) continue;
    const Station &from = stations[i - 1], &to = stations[i];
    points[i].metres_before = 0.5 * (to.l_m - from.l_m);
    points[i].seconds_before = points[i].metres_before / mean_speed_mps(from, to);
  }
  return points;
}

PartialArcLengths partial_arc_lengths(std::span<const LinearPoint> points,
                                      std::span<const double> end_d_m) {
  PartialArcLengths lengths;
  PartialArcLengths::Lanes e{};
  std::ranges::copy(end_d_m, e.begin());
  add_stretches(points.data(), points.size(), e.data(), lengths);
  return lengths;
}

}  // namespace roadbed::planning::lateral
