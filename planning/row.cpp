#include "roadbed/planning/row.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "roadbed/planning/row_kernel.h"

namespace roadbed::planning {
namespace {

using geometry::FrameVelocity;
using geometry::Quintic;
using geometry::SpeedAndTurn;

// A row at one station: d and its derivatives are at_zero + d_e · per_unit.
struct RowStation {
  const Station& station;
  Quintic::Derivatives at_zero, per_unit;
  double share;  // of the trapezoidal mean
};

std::vector<RowStation> row_stations(const std::vector<Station>& stations,
                                     const QuinticFamily& family) {
  const double step = 1.0 / static_cast<double>(stations.size() - 1);
  std::vector<RowStation> row;
  row.reserve(stations.size());
  for (const Station& station : stations) {
    row.push_back({station, family.at_zero.at(station.l_m), family.per_unit.at(station.l_m), step});
  }
  row.front().share = row.back().share = 0.5 * step;
  return row;
}

double weight_of(const RowQuestion& question, CostTerm term, double scale) {
  return of(question.weights, term) / (scale * scale);
}

void set_quadratics(const RowStation& at, KernelPoint& point) {
  const geometry::CurvatureDerivatives line = curvatures(at.station.line);
  const FrameVelocity u = geometry::frame_velocity(line, at.at_zero);
  FrameVelocity v = geometry::frame_velocity(line, at.per_unit);
  v.along[0] -= 1.0;  // 1 − κ d: the one belongs to at_zero
  const SpeedAndTurn uu = geometry::mixed(line, u, u), uv = geometry::mixed(line, u, v),
                     vu = geometry::mixed(line, v, u), vv = geometry::mixed(line, v, v);
  for (std::size_t i = 0; i < 4; ++i) {
    point.g[i][0] = uu.g[i];
    point.g[i][1] = uv.g[i] + vu.g[i];
    point.g[i][2] = vv.g[i];
    point.q[i][0] = uu.q[i];
    point.q[i][1] = uv.q[i] + vu.q[i];
    point.q[i][2] = vv.q[i];
  }
}

void set_weights(const RowStation& at, const RowQuestion& question, KernelPoint& point) {
  const double v = at.station.speed.speed_mps, a = at.station.speed.acceleration_mps2;
  const auto weight = [&](CostTerm term, double scale) {
    return at.share * weight_of(question, term, scale);
  };
  point.fourth_power = v * v * v * v;
  point.curvature_weight =
      weight(CostTerm::curvature, cost_scale::kCurvature_per_m) +
      weight(CostTerm::lateral_acceleration, cost_scale::kAcceleration_mps2) * point.fourth_power;
  point.curvature_d1_weight = weight(CostTerm::curvature_rate, cost_scale::kCurvatureD1_per_m2);
  point.curvature_d2_weight = weight(CostTerm::curvature_second, cost_scale::kCurvatureD2_per_m3);
  point.curvature_d3_weight = weight(CostTerm::curvature_third, cost_scale::kCurvatureD3_per_m4);
  const double jerk = std::sqrt(weight(CostTerm::lateral_jerk, cost_scale::kJerk_mps3));
  point.jerk_per_k = jerk * 2.0 * v * a;
  point.jerk_per_d1 = jerk * v * v * v;
  point.time_weight = at.share * question.frame.end_l_m / std::max(v, kSlowestCounted_mps);
}

// Those terms whose sum over a row's stations is c[0] + e (c[1] + e c[2]) in closed form.
struct Quadratic {
  double c[3] = {0.0, 0.0, 0.0};
  void add_square(double weight, double at_zero, double per_unit) {
    c[0] += weight * at_zero * at_zero;
    c[1] += 2.0 * weight * at_zero * per_unit;
    c[2] += weight * per_unit * per_unit;
  }
  double at(double e) const { return c[0] + e * (c[1] + e * c[2]); }
};

Quadratic closed_form_cost(const std::vector<RowStation>& row, const RowQuestion& question) {
  const double acceleration =
      weight_of(question, CostTerm::longitudinal_acceleration, cost_scale::kAcceleration_mps2);
  const double jerk = weight_of(question, CostTerm::longitudinal_jerk, cost_scale::kJerk_mps3);
  const double offset = weight_of(question, CostTerm::offset, cost_scale::kOffset_m);
  const double consistency = weight_of(question, CostTerm::consistency, cost_scale::kConsistency_m);
  Quadratic sum;
  sum.c[0] = of(question.weights, CostTerm::length) * length_term(question.frame);
  for (const RowStation& at : row) {
    sum.add_square(at.share * acceleration, at.station.speed.acceleration_mps2, 0.0);
    sum.add_square(at.share * jerk, at.station.speed.jerk_mps3, 0.0);
    sum.add_square(at.share * offset, at.at_zero[0], at.per_unit[0]);
    if (at.station.previous_d_m) {
      sum.add_square(at.share * consistency, at.at_zero[0] - *at.station.previous_d_m,
                     at.per_unit[0]);
    }
  }
  return sum;
}

// Values of d_e for which every station keeps a limit on d.
struct Interval {
  double from = -std::numeric_limits<double>::infinity();
  double to = std::numeric_limits<double>::infinity();

  void keep(double least_d, double most_d, const RowStation& at) {
    const double at_zero = at.at_zero[0], per_unit = at.per_unit[0];
    if (per_unit > kFixed) {
      from = std::max(from, (least_d - at_zero) / per_unit);
      to = std::min(to, (most_d - at_zero) / per_unit);
    } else if (!(at_zero >= least_d && at_zero <= most_d)) {
      from = std::numeric_limits<double>::infinity();  // the start breaks it for all of them
    }
  }
  bool holds(double e) const { return e >= from && e <= to; }

  static constexpr double kFixed = 1e-12;  // at the start d does not depend on d_e
};

Interval on_road(const std::vector<RowStation>& row) {
  Interval interval;
  for (const RowStation& at : row) {
    interval.keep(at.station.min_d_m - kLimitSlack, at.station.max_d_m + kLimitSlack, at);
  }
  return interval;
}

// 1 − κ d > kLeastUnfolded.
Interval unfolded(const std::vector<RowStation>& row) {
  const double infinity = std::numeric_limits<double>::infinity();
  Interval interval;
  for (const RowStation& at : row) {
    const double curvature = at.station.line.curvature_per_m;
    if (curvature == 0.0) continue;
    const double limit_d = (1.0 - kLeastUnfolded) / curvature;
    interval.keep(curvature < 0.0 ? limit_d : -infinity, curvature < 0.0 ? infinity : limit_d, at);
  }
  return interval;
}

double squared(double value) { return value * value; }

struct LaneSums {
  explicit LaneSums(std::size_t lanes)
      : cost(lanes), duration_s(lanes), curvature_squared(lanes), acceleration_squared(lanes) {}
  KernelSums view() { return {cost, duration_s, curvature_squared, acceleration_squared}; }
  std::vector<double> cost, duration_s, curvature_squared, acceleration_squared;
};

LaneSums sum_over_stations(const std::vector<RowStation>& row, const RowQuestion& question) {
  std::vector<KernelPoint> points(row.size());
  for (std::size_t i = 0; i < row.size(); ++i) {
    set_quadratics(row[i], points[i]);
    set_weights(row[i], question, points[i]);
  }
  LaneSums sums(question.end_d_m.size());
  run_kernel(points, question.end_d_m, sums.view());
  return sums;
}

std::vector<Rejection> verdicts(const std::vector<RowStation>& row, const RowQuestion& question,
                                const LaneSums& sums) {
  const Interval road = on_road(row), plain = unfolded(row);
  const double curvature_squared = squared(question.limits.max_curvature_per_m);
  const double acceleration_squared = squared(question.limits.max_lateral_acceleration_mps2);
  std::vector<Rejection> rejection(question.end_d_m.size(), Rejection::none);
  for (std::size_t lane = 0; lane < rejection.size(); ++lane) {
    const double e = question.end_d_m[lane];
    if (!road.holds(e)) {
      rejection[lane] = Rejection::off_road;
    } else if (!plain.holds(e) || !(sums.curvature_squared[lane] <= curvature_squared)) {
      rejection[lane] = Rejection::beyond_curvature;
    } else if (!(sums.acceleration_squared[lane] <= acceleration_squared)) {
      rejection[lane] = Rejection::lateral_acceleration;
    }
  }
  return rejection;
}

}  // namespace

RowResult evaluate_row(const std::vector<Station>& stations, const QuinticFamily& family,
                       const RowQuestion& question) {
  const std::vector<RowStation> row = row_stations(stations, family);
  LaneSums sums = sum_over_stations(row, question);
  const Quadratic closed_form = closed_form_cost(row, question);
  const double per_duration =
      std::max(question.frame.start_speed_mps, kSlowestCounted_mps) / question.frame.max_l_m;
  for (std::size_t lane = 0; lane < sums.cost.size(); ++lane) {
    sums.cost[lane] +=
        closed_form.at(question.end_d_m[lane]) +
        of(question.weights, CostTerm::time) * squared(sums.duration_s[lane] * per_duration);
  }
  std::vector<Rejection> rejection = verdicts(row, question, sums);
  return {std::move(sums.cost), std::move(rejection)};
}

}  // namespace roadbed::planning
