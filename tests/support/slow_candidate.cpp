#include "roadbed/tests/support/slow_candidate.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

#include "roadbed/planning/lateral/planned_speed.h"
#include "roadbed/tests/support/power_series.h"

namespace roadbed::tests {
namespace {

using planning::CostTerm;
using planning::PlanInput;
using planning::PlanOptions;
using Real = long double;
using Polynomial = Eigen::Matrix<Real, 6, 1>;

Polynomial solve_quintic(const planning::LateralState& start, Real end_d, Real end_l) {
  Eigen::Matrix<Real, 6, 6> rows = Eigen::Matrix<Real, 6, 6>::Zero();
  for (int end = 0; end < 2; ++end) {
    const Real l = end == 0 ? 0 : end_l;
    for (int j = 0; j < 6; ++j) {
      rows(3 * end, j) = std::pow(l, Real(j));
      if (j >= 1) rows(3 * end + 1, j) = j * std::pow(l, Real(j - 1));
      if (j >= 2) rows(3 * end + 2, j) = j * (j - 1) * std::pow(l, Real(j - 2));
    }
  }
  Polynomial right;
  right << start.d_m, start.d_slope, start.d_curvature_per_m, end_d, 0, 0;
  return rows.fullPivLu().solve(right);
}

// d around l, as a series in the step from l.
PowerSeries expand(const Polynomial& polynomial, Real l) {
  PowerSeries series;
  for (std::size_t order = 0; order < PowerSeries::kOrder; ++order) {
    for (std::size_t j = order; j < 6; ++j) {
      Real binomial = 1;
      for (std::size_t k = 0; k < order; ++k) binomial *= Real(j - k) / Real(k + 1);
      series[order] +=
          binomial * polynomial[static_cast<Eigen::Index>(j)] * std::pow(l, Real(j - order));
    }
  }
  return series;
}

PowerSeries line_curvature(const planning::ReferencePoint& point) {
  PowerSeries series;
  series[0] = point.curvature_per_m;
  series[1] = point.curvature_d1_per_m2;
  series[2] = Real(point.curvature_d2_per_m3) / 2;
  series[3] = Real(point.curvature_d3_per_m4) / 6;
  series[4] = Real(point.curvature_d4_per_m5) / 24;
  return series;
}

struct Motion {
  Real along = 0, across = 0;  // dp/ds in the line's frame
  Real stretch = 0, k = 0, k1 = 0, k2 = 0, k3 = 0;
};

// p(s) = r(s) + d n in the fixed frame of the line at the point of expansion; curvature is
// (x′ y″ − y′ x″) / |p′|³, its derivatives follow from d/dσ = (1/|p′|) d/ds.
Motion move(const PowerSeries& curvature, const PowerSeries& d) {
  const CosineAndSine turn = cosine_and_sine(integral(curvature));
  PowerSeries one;
  one[0] = 1;
  const PowerSeries along = one - curvature * d, across = derivative(d);
  const PowerSeries x = along * turn.cosine - across * turn.sine;
  const PowerSeries y = along * turn.sine + across * turn.cosine;
  const PowerSeries squared = x * x + y * y;
  const PowerSeries stretch = square_root(squared);
  const PowerSeries k = (x * derivative(y) - y * derivative(x)) / (squared * stretch);
  const PowerSeries k1 = derivative(k) / stretch, k2 = derivative(k1) / stretch,
                    k3 = derivative(k2) / stretch;
  return {along[0], across[0], stretch[0], k[0], k1[0], k2[0], k3[0]};
}

struct Sums {
  Real k = 0, k1 = 0, k2 = 0, k3 = 0, d = 0, a_lat = 0, a_lon = 0, j_lat = 0, j_lon = 0,
       consistency = 0, duration = 0;
};

void add_sample(Sums& sums, Real fraction, const Motion& m, Real d, Real previous_d,
                const planning::PlannedSpeed::State& speed) {
  const Real v = speed.speed_mps, a = speed.acceleration_mps2;
  const Real jerk = 2 * v * a * m.k + v * v * v * m.k1;
  sums.k += fraction * m.k * m.k;
  sums.k1 += fraction * m.k1 * m.k1;
  sums.k2 += fraction * m.k2 * m.k2;
  sums.k3 += fraction * m.k3 * m.k3;
  sums.d += fraction * d * d;
  sums.a_lat += fraction * v * v * m.k * v * v * m.k;
  sums.a_lon += fraction * a * a;
  sums.j_lat += fraction * jerk * jerk;
  sums.j_lon += fraction * Real(speed.jerk_mps3) * Real(speed.jerk_mps3);
  sums.consistency += fraction * (d - previous_d) * (d - previous_d);
  sums.duration += fraction * m.stretch / std::max(v, Real(1));
}

planning::CostTerms terms_of(const Sums& sums, double end_l, double max_l, double v0) {
  const Real missing = 1 - Real(end_l) / max_l;
  const Real fraction = sums.duration * end_l * std::max(v0, 1.0) / max_l;
  const auto in = [](Real sum, Real scale) { return static_cast<double>(sum / (scale * scale)); };
  return {static_cast<double>(missing * missing),
          in(sums.k, 0.05L),
          in(sums.k1, 0.026L),
          in(sums.k2, 0.008L),
          in(sums.k3, 0.0008L),
          in(sums.d, 1.0L),
          in(sums.a_lat, 2.0L),
          in(sums.a_lon, 2.0L),
          in(sums.j_lat, 2.0L),
          in(sums.j_lon, 2.0L),
          in(sums.consistency, 0.5L),
          static_cast<double>(fraction * fraction)};
}

// Adds a pose, with the time that the way from the last one takes.
void drive_to(SlowCandidate& slow, double s_m, const planning::ReferencePoint& line, double d,
              const Motion& m, double speed_mps, double from_last_m) {
  const double heading = line.heading_rad;
  const double last_mps = slow.drive.empty() ? speed_mps : slow.drive.back().speed_mps;
  const double last_s = slow.drive.empty() ? 0.0 : slow.drive.back().t_s;
  slow.drive_s_m.push_back(s_m);
  slow.drive.push_back({.t_s = last_s + from_last_m / std::max(0.5 * (last_mps + speed_mps), 0.05),
                        .x_m = line.in_map.x() - d * std::sin(heading),
                        .y_m = line.in_map.y() + d * std::cos(heading),
                        .heading_rad = heading + static_cast<double>(std::atan2(m.across, m.along)),
                        .speed_mps = speed_mps});
}

}  // namespace

SlowCandidate slow_candidate(const PlanInput& input, const PlanOptions& options, double longest_l_m,
                             double end_d_m, double end_l_m) {
  SlowCandidate slow{.least_d_m = 1e300, .most_d_m = -1e300, .drive = {}, .drive_s_m = {}};
  const planning::PlannedSpeed speed(input.speed);
  const Polynomial polynomial = solve_quintic(input.start, end_d_m, end_l_m);
  const int sections = options.points - 1;
  Sums sums;
  Real last_stretch = 0;
  double last_l = 0.0;
  const auto visit = [&](double l, Real fraction) {
    const double s_m = input.start.s_m + l;
    const planning::ReferencePoint line = input.line.at(s_m);
    PowerSeries d;
    d[0] = end_d_m;
    if (l <= end_l_m) d = expand(polynomial, l);
    const Motion motion = move(line_curvature(line), d);
    const auto state = speed.at(l);
    if (motion.along <= 0.05L && l > end_l_m) return false;
    slow.folded = slow.folded || motion.along <= 0.05L;
    const double driven_m =
        l > 0.0 ? 0.5 * static_cast<double>(last_stretch + motion.stretch) * (l - last_l) : 0.0;
    drive_to(slow, s_m, line, static_cast<double>(d[0]), motion, state.speed_mps, driven_m);
    last_stretch = motion.stretch;
    last_l = l;
    if (fraction == 0) return true;
    const Real previous_d = input.previous_d_m ? Real(input.previous_d_m(s_m)) : d[0];
    add_sample(sums, fraction, motion, d[0], previous_d, state);
    const double k = static_cast<double>(std::abs(motion.k));
    slow.worst_curvature_per_m = std::max(slow.worst_curvature_per_m, k);
    slow.worst_lateral_mps2 =
        std::max(slow.worst_lateral_mps2, k * state.speed_mps * state.speed_mps);
    const Real wheelbase = geometry::VehicleShape{}.wheelbase_m, tangent = wheelbase * motion.k;
    const Real turn = wheelbase * motion.k1 * Real(state.speed_mps) / (1 + tangent * tangent);
    slow.worst_steering_radps =
        std::max(slow.worst_steering_radps, static_cast<double>(std::abs(turn)));
    slow.least_d_m = std::min(slow.least_d_m, static_cast<double>(d[0]));
    slow.most_d_m = std::max(slow.most_d_m, static_cast<double>(d[0]));
    return true;
  };
  for (int i = 0; i <= sections; ++i) {
    visit(end_l_m * i / sections, (i == 0 || i == sections ? 0.5L : 1.0L) / sections);
  }
  for (int i = 0; i <= sections; ++i) {
    const double l = longest_l_m * i / sections;
    if (l > end_l_m + 0.25 * end_l_m / sections && !visit(l, 0)) break;
  }
  slow.terms = terms_of(sums, end_l_m, longest_l_m, input.speed.speed_mps);
  for (std::size_t i = 0; i < slow.terms.size(); ++i) {
    slow.cost += options.weights[i] * slow.terms[i];
  }
  return slow;
}

}  // namespace roadbed::tests
