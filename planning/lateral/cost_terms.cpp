#include "roadbed/planning/lateral/cost_terms.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace roadbed::planning::inline lateral {
namespace {

constexpr std::array<std::string_view, kCostTerms> kNames = {
    "length",
    "curvature",
    "curvature_rate",
    "curvature_second",
    "curvature_third",
    "offset",
    "lateral_acceleration",
    "longitudinal_acceleration",
    "lateral_jerk",
    "longitudinal_jerk",
    "consistency",
    "time",
};

// Trapezoidal mean of a quantity over equally spaced points.
template <typename Quantity>
double mean(std::span<const CostPoint> points, const Quantity& quantity) {
  double sum = 0.5 * (quantity(points.front()) + quantity(points.back()));
  for (std::size_t i = 1; i + 1 < points.size(); ++i) sum += quantity(points[i]);
  return sum / static_cast<double>(points.size() - 1);
}

template <typename Quantity>
double mean_square(std::span<const CostPoint> points, double scale, const Quantity& quantity) {
  return mean(points, [&](const CostPoint& point) {
    const double scaled = quantity(point) / scale;
    return scaled * scaled;
  });
}

double counted_speed_mps(double speed_mps) { return std::max(speed_mps, kSlowestCounted_mps); }

}  // namespace

std::string_view to_string(CostTerm term) { return kNames.at(static_cast<std::size_t>(term)); }

double length_term(const CostFrame& frame) {
  const double missing = 1.0 - frame.end_l_m / frame.max_l_m;
  return missing * missing;
}

double curvature_term(std::span<const CostPoint> points) {
  return mean_square(points, cost_scale::kCurvature_per_m,
                     [](const CostPoint& p) { return p.curvature_per_m; });
}

double curvature_rate_term(std::span<const CostPoint> points) {
  return mean_square(points, cost_scale::kCurvatureD1_per_m2,
                     [](const CostPoint& p) { return p.curvature_d1_per_m2; });
}

double curvature_second_term(std::span<const CostPoint> points) {
  return mean_square(points, cost_scale::kCurvatureD2_per_m3,
                     [](const CostPoint& p) { return p.curvature_d2_per_m3; });
}

double curvature_third_term(std::span<const CostPoint> points) {
  return mean_square(points, cost_scale::kCurvatureD3_per_m4,
                     [](const CostPoint& p) { return p.curvature_d3_per_m4; });
}

double offset_term(std::span<const CostPoint> points) {
  return mean_square(points, cost_scale::kOffset_m, [](const CostPoint& p) { return p.d_m; });
}

double lateral_acceleration_term(std::span<const CostPoint> points) {
  return mean_square(points, cost_scale::kAcceleration_mps2, [](const CostPoint& p) {
    return p.speed_mps * p.speed_mps * p.curvature_per_m;
  });
}

double longitudinal_acceleration_term(std::span<const CostPoint> points) {
  return mean_square(points, cost_scale::kAcceleration_mps2,
                     [](const CostPoint& p) { return p.acceleration_mps2; });
}

double lateral_jerk_term(std::span<const CostPoint> points) {
  return mean_square(points, cost_scale::kJerk_mps3, [](const CostPoint& p) {
    const double v = p.speed_mps;
    return v * (2.0 * p.acceleration_mps2 * p.curvature_per_m + v * v * p.curvature_d1_per_m2);
  });
}

double longitudinal_jerk_term(std::span<const CostPoint> points) {
  return mean_square(points, cost_scale::kJerk_mps3,
                     [](const CostPoint& p) { return p.jerk_mps3; });
}

double consistency_term(std::span<const CostPoint> points) {
  return mean_square(points, cost_scale::kConsistency_m,
                     [](const CostPoint& p) { return p.d_m - p.previous_d_m; });
}

double time_term(std::span<const CostPoint> points, const CostFrame& frame) {
  const double duration_s = frame.end_l_m * mean(points, [](const CostPoint& p) {
                              return p.stretch / counted_speed_mps(p.speed_mps);
                            });
  const double fraction = duration_s * counted_speed_mps(frame.start_speed_mps) / frame.max_l_m;
  return fraction * fraction;
}

CostTerms cost_terms(std::span<const CostPoint> points, const CostFrame& frame) {
  return {length_term(frame),
          curvature_term(points),
          curvature_rate_term(points),
          curvature_second_term(points),
          curvature_third_term(points),
          offset_term(points),
          lateral_acceleration_term(points),
          longitudinal_acceleration_term(points),
          lateral_jerk_term(points),
          longitudinal_jerk_term(points),
          consistency_term(points),
          time_term(points, frame)};
}

double total_cost(const CostTerms& terms, const CostTerms& weights) {
  double cost = 0.0;
  for (std::size_t i = 0; i < terms.size(); ++i) cost += weights[i] * terms[i];
  return cost;
}

CostTerms default_weights() {
  CostTerms weights{};
  of(weights, CostTerm::length) = 2.0;
  of(weights, CostTerm::curvature) = 0.2;
  of(weights, CostTerm::curvature_rate) = 0.2;
  of(weights, CostTerm::curvature_second) = 0.1;
  of(weights, CostTerm::curvature_third) = 0.05;
  of(weights, CostTerm::offset) = 1.0;
  of(weights, CostTerm::lateral_acceleration) = 0.5;
  of(weights, CostTerm::longitudinal_acceleration) = 0.1;
  of(weights, CostTerm::lateral_jerk) = 0.2;
  of(weights, CostTerm::longitudinal_jerk) = 0.1;
  of(weights, CostTerm::consistency) = 0.5;
  of(weights, CostTerm::time) = 0.2;
  return weights;
}

void check_weights(const CostTerms& weights) {
  for (std::size_t i = 0; i < weights.size(); ++i) {
    if (!(weights[i] >= 0.0) || !std::isfinite(weights[i])) {
      throw std::invalid_argument(fmt::format("weights: {} must be finite and not negative, got {}",
                                              kNames[i], weights[i]));
    }
  }
}

}  // namespace roadbed::planning::lateral
