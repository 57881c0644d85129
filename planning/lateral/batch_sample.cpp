#include "roadbed/planning/lateral/batch_sample.h"

#include <algorithm>
#include <cmath>

namespace roadbed::planning::inline lateral {
namespace {

using geometry::FrameVelocity;
using geometry::SpeedAndTurn;

constexpr double kFixed = 1e-12;  // at the start d does not depend on d_e

double weight_of(const BatchConfig& config, CostTerm term, double scale) {
  return of(config.weights, term) / (scale * scale);
}

// The velocity in the line's frame is u + d_e v, as offsets are linear in d_e. Speed and turn of
// the path are bilinear in it, so each of their derivatives is a quadratic in d_e.
void set_quadratics(const BatchSample& at, KernelPoint& point) {
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

// What `cost_terms` computes for one candidate, as factors of |κ|² … |κ‴|² at a sample: a term's
// weight over its squared scale, times the sample's part of the trapezoidal mean. The lateral jerk
// is d(v² κ)/dt = 2 v a κ + v³ κ′.
void set_weights(const BatchSample& at, const BatchConfig& config, KernelPoint& point) {
  const double v = at.station.speed.speed_mps, a = at.station.speed.acceleration_mps2;
  const auto weight = [&](CostTerm term, double scale) {
    return at.mean_weight * weight_of(config, term, scale);
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
  point.steering_per_k1 = config.limits.wheelbase_m * v;
  point.steering_rate = config.limits.max_steering_rate_radps;
  point.steering_rate_per_kk =
      point.steering_rate * config.limits.wheelbase_m * config.limits.wheelbase_m;
  point.time_weight = at.mean_weight * config.frame.end_l_m / std::max(v, kSlowestCounted_mps);
}

}  // namespace

std::vector<BatchSample> batch_samples(const std::vector<Station>& stations,
                                       const QuinticFamily& family) {
  const double step = 1.0 / static_cast<double>(stations.size() - 1);
  std::vector<BatchSample> batch;
  batch.reserve(stations.size());
  for (const Station& station : stations) {
    batch.push_back(
        {station, family.at_zero.at(station.l_m), family.per_unit.at(station.l_m), step});
  }
  batch.front().mean_weight = batch.back().mean_weight = 0.5 * step;
  return batch;
}

KernelPoint kernel_point(const BatchSample& at, const BatchConfig& config) {
  KernelPoint point;
  set_quadratics(at, point);
  set_weights(at, config, point);
  return point;
}

EndOffsetQuadratic closed_form_cost(const std::vector<BatchSample>& batch,
                                    const BatchConfig& config) {
  const double acceleration =
      weight_of(config, CostTerm::longitudinal_acceleration, cost_scale::kAcceleration_mps2);
  const double jerk = weight_of(config, CostTerm::longitudinal_jerk, cost_scale::kJerk_mps3);
  const double offset = weight_of(config, CostTerm::offset, cost_scale::kOffset_m);
  const double consistency = weight_of(config, CostTerm::consistency, cost_scale::kConsistency_m);
  EndOffsetQuadratic sum;
  sum.c[0] = of(config.weights, CostTerm::length) * length_term(config.frame);
  for (const BatchSample& at : batch) {
    sum.add_square(at.mean_weight * acceleration, at.station.speed.acceleration_mps2, 0.0);
    sum.add_square(at.mean_weight * jerk, at.station.speed.jerk_mps3, 0.0);
    sum.add_square(at.mean_weight * offset, at.at_zero[0], at.per_unit[0]);
    if (at.station.previous_d_m) {
      sum.add_square(at.mean_weight * consistency, at.at_zero[0] - *at.station.previous_d_m,
                     at.per_unit[0]);
    }
  }
  return sum;
}

void OffsetInterval::keep(double least_d, double most_d, double at_zero, double per_unit) {
  if (per_unit > kFixed) {
    from = std::max(from, (least_d - at_zero) / per_unit);
    to = std::min(to, (most_d - at_zero) / per_unit);
  } else if (!(at_zero >= least_d && at_zero <= most_d)) {
    from = std::numeric_limits<double>::infinity();  // the start breaks it for all of them
  }
}

OffsetInterval end_offsets_on_road(const std::vector<BatchSample>& batch) {
  OffsetInterval interval;
  for (const BatchSample& at : batch) {
    interval.keep(at.station.min_d_m - kLimitSlack, at.station.max_d_m + kLimitSlack, at.at_zero[0],
                  at.per_unit[0]);
  }
  return interval;
}

OffsetInterval end_offsets_on_road(const CycleContext& context, const QuinticFamily& family,
                                   int count) {
  OffsetInterval interval;
  for (int i = 0; i < count; ++i) {
    const double l_m = family.at_zero.length() * i / (count - 1);
    const OffsetRange range = offsets_on_road(context, l_m);
    interval.keep(range.min_d_m - kLimitSlack, range.max_d_m + kLimitSlack,
                  family.at_zero.at(l_m)[0], family.per_unit.at(l_m)[0]);
  }
  return interval;
}

OffsetInterval end_offsets_unfolded(const std::vector<BatchSample>& batch) {
  const double infinity = std::numeric_limits<double>::infinity();
  OffsetInterval interval;
  for (const BatchSample& at : batch) {
    const double curvature = at.station.line.curvature_per_m;
    if (curvature == 0.0) continue;
    const double limit_d = (1.0 - kLeastUnfolded) / curvature;
    interval.keep(curvature < 0.0 ? limit_d : -infinity, curvature < 0.0 ? infinity : limit_d,
                  at.at_zero[0], at.per_unit[0]);
  }
  return interval;
}

}  // namespace roadbed::planning::lateral
