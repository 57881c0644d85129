#include "roadbed/planning/lateral/cost_terms.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>
#include <stdexcept>
#include <vector>

#include "roadbed/planning/lateral/candidates.h"
#include "roadbed/tests/support/analytic_line.h"

namespace roadbed::planning {
namespace {

using Real = long double;

// The candidate as a curve of the plane in long double: beside a circle of radius R, centre (0, R).
struct Curve {
  static constexpr Real kRadius = 40;
  std::array<Real, 6> d;  // coefficients of the quintic

  Real offset(Real s) const {
    Real value = 0;
    for (std::size_t j = 6; j-- > 0;) value = value * s + d[j];
    return value;
  }
  Real x(Real s) const { return (kRadius - offset(s)) * std::sin(s / kRadius); }
  Real y(Real s) const { return kRadius - (kRadius - offset(s)) * std::cos(s / kRadius); }
};

constexpr Real kStep = 0.05L;

// Central difference of order eight.
template <typename Function>
Real derivative(const Function& f, Real s) {
  const auto difference = [&](int n) { return f(s + n * kStep) - f(s - n * kStep); };
  return (4 * difference(1) / 5 - difference(2) / 5 + 4 * difference(3) / 105 -
          difference(4) / 280) /
         kStep;
}

// Curvature and its derivatives by differences of positions alone.
struct Differences {
  Curve curve;
  Real dx(Real s) const {
    return derivative([&](Real u) { return curve.x(u); }, s);
  }
  Real dy(Real s) const {
    return derivative([&](Real u) { return curve.y(u); }, s);
  }
  Real stretch(Real s) const { return std::hypot(dx(s), dy(s)); }
  Real k(Real s) const {
    const Real ddx = derivative([&](Real u) { return dx(u); }, s);
    const Real ddy = derivative([&](Real u) { return dy(u); }, s);
    return (dx(s) * ddy - dy(s) * ddx) / std::pow(stretch(s), Real(3));
  }
  Real k1(Real s) const {
    return derivative([&](Real u) { return k(u); }, s) / stretch(s);
  }
  Real k2(Real s) const {
    return derivative([&](Real u) { return k1(u); }, s) / stretch(s);
  }
  Real k3(Real s) const {
    return derivative([&](Real u) { return k2(u); }, s) / stretch(s);
  }
};

struct Sampled {
  std::vector<Station> stations;
  geometry::Quintic quintic;
  std::vector<CostPoint> points;
  Differences slow;
  static constexpr double kLength_m = 18.0;

  double s(std::size_t i) const { return stations[i].l_m; }

  // Trapezoidal mean of (f / scale)².
  double mean_square(double scale, const std::function<Real(std::size_t)>& f) const {
    Real sum = 0;
    for (std::size_t i = 0; i < points.size(); ++i) {
      const Real value = f(i) / static_cast<Real>(scale);
      sum += value * value * (i == 0 || i + 1 == points.size() ? 0.5L : 1.0L);
    }
    return static_cast<double>(sum / static_cast<Real>(points.size() - 1));
  }
};

Sampled sample() {
  const tests::AnalyticLine circle{
      .curvature = {1.0 / static_cast<double>(Curve::kRadius), 0, 0, 0, 0}};
  const LineView view = circle.view();
  const std::function<double(double)> previous = [](double s_m) { return 0.2 + 0.03 * s_m; };
  const CycleContext context{.line = view,
                             .start = {.d_m = 0.4, .d_slope = 0.06, .d_curvature_per_m = 0.004},
                             .speed = PlannedSpeed({9.0, 1.2, 11.0}),
                             .previous_d_m = previous,
                             .half_width_m = 0.8,
                             .recovery_m = 10.0};
  const geometry::Quintic quintic = QuinticFamily(context.start, Sampled::kLength_m).member(-1.3);
  Sampled sampled{stations_over(context, Sampled::kLength_m, 13), quintic, {}, {}};
  sampled.points = cost_points(sampled.stations, quintic);
  for (std::size_t j = 0; j < 6; ++j) sampled.slow.curve.d[j] = quintic.coefficients()[j];
  return sampled;
}

TEST(Cost, CurvatureTermsAreThoseOfADifferentiatedCurve) {
  const Sampled c = sample();
  const auto expect = [&](double term, double scale, auto slow) {
    EXPECT_NEAR(term, c.mean_square(scale, [&](std::size_t i) { return slow(c.s(i)); }), 1e-6);
  };
  expect(curvature_term(c.points), 0.05, [&](Real s) { return c.slow.k(s); });
  expect(curvature_rate_term(c.points), 0.026, [&](Real s) { return c.slow.k1(s); });
  expect(curvature_second_term(c.points), 0.008, [&](Real s) { return c.slow.k2(s); });
}

TEST(Cost, ThirdDerivativeTermIsThatOfADifferentiatedCurve) {
  const Sampled c = sample();
  // d³k/dσ³ by differences of the closed-form second one, itself tested above.
  const auto k2 = [&](Real s) {
    const geometry::CurvatureDerivatives line = {1.0 / static_cast<double>(Curve::kRadius), 0, 0, 0,
                                                 0};
    return static_cast<Real>(
        geometry::offset_curve(line, c.quintic.at(static_cast<double>(s)), 0.05)
            ->curvature_d2_per_m3);
  };
  EXPECT_NEAR(curvature_third_term(c.points),
              c.mean_square(0.0008,
                            [&](std::size_t i) {
                              return derivative(k2, static_cast<Real>(c.s(i))) /
                                     c.slow.stretch(c.s(i));
                            }),
              1e-6);
}

TEST(Cost, OffsetAndConsistencyCompareWithTheLineAndTheLastPlan) {
  const Sampled c = sample();
  EXPECT_NEAR(offset_term(c.points),
              c.mean_square(1.0, [&](std::size_t i) { return c.slow.curve.offset(c.s(i)); }),
              1e-12);
  EXPECT_NEAR(consistency_term(c.points),
              c.mean_square(0.5,
                            [&](std::size_t i) {
                              return c.slow.curve.offset(c.s(i)) -
                                     (0.2L + 0.03L * static_cast<Real>(c.s(i)));
                            }),
              1e-12);
}

TEST(Cost, LateralAccelerationAndJerkAreThoseOfADrive) {
  const Sampled c = sample();
  const PlannedSpeed speed({9.0, 1.2, 11.0});
  const auto v = [&](Real s) {
    return static_cast<Real>(speed.at(static_cast<double>(s)).speed_mps);
  };
  EXPECT_NEAR(
      lateral_acceleration_term(c.points),
      c.mean_square(2.0, [&](std::size_t i) { return v(c.s(i)) * v(c.s(i)) * c.slow.k(c.s(i)); }),
      1e-9);
  EXPECT_NEAR(lateral_jerk_term(c.points),
              c.mean_square(2.0,
                            [&](std::size_t i) {
                              const Real s = c.s(i), a = speed.at(c.s(i)).acceleration_mps2;
                              return 2 * v(s) * a * c.slow.k(s) + v(s) * v(s) * v(s) * c.slow.k1(s);
                            }),
              1e-7);
}

TEST(Cost, LongitudinalTermsAreThoseOfTheSpeedPlan) {
  const Sampled c = sample();
  const PlannedSpeed speed({9.0, 1.2, 11.0});
  EXPECT_NEAR(
      longitudinal_acceleration_term(c.points),
      c.mean_square(2.0, [&](std::size_t i) { return Real(speed.at(c.s(i)).acceleration_mps2); }),
      1e-12);
  EXPECT_NEAR(longitudinal_jerk_term(c.points),
              c.mean_square(2.0, [&](std::size_t i) { return Real(speed.at(c.s(i)).jerk_mps3); }),
              1e-12);
  EXPECT_GT(longitudinal_jerk_term(c.points), 0.0);
}

TEST(Cost, TimeIsTheDurationAgainstTheLongestAtThePresentSpeed) {
  const Sampled c = sample();
  const CostFrame frame{.end_l_m = Sampled::kLength_m, .max_l_m = 30.0, .start_speed_mps = 9.0};
  Real duration = 0;
  for (std::size_t i = 0; i + 1 < c.points.size(); ++i) {
    const auto slowness = [&](std::size_t n) {
      return c.slow.stretch(c.s(n)) / Real(c.points[n].speed_mps);
    };
    duration += (slowness(i) + slowness(i + 1)) / 2 * Real(c.s(i + 1) - c.s(i));
  }
  const double fraction = static_cast<double>(duration) * 9.0 / 30.0;
  EXPECT_NEAR(time_term(c.points, frame), fraction * fraction, 1e-9);
}

TEST(Cost, LengthPrefersTheLongestCandidate) {
  EXPECT_EQ(length_term({.end_l_m = 30.0, .max_l_m = 30.0, .start_speed_mps = 0.0}), 0.0);
  EXPECT_NEAR(length_term({.end_l_m = 15.0, .max_l_m = 30.0, .start_speed_mps = 0.0}), 0.25, 1e-15);
}

TEST(Cost, KeepsItsMeaningWhenThereAreMorePoints) {
  const tests::AnalyticLine circle{.curvature = {0.02, 0, 0, 0, 0}};
  const LineView view = circle.view();
  const std::function<double(double)> none;
  const CycleContext context{.line = view,
                             .start = {.d_m = 1.0},
                             .speed = PlannedSpeed({10.0, 0.5, 12.0}),
                             .previous_d_m = none,
                             .half_width_m = 0.8,
                             .recovery_m = 10.0};
  const geometry::Quintic quintic = QuinticFamily(context.start, 20.0).member(-1.0);
  const CostFrame frame{20.0, 30.0, 10.0};
  const CostTerms few = cost_terms(cost_points(stations_over(context, 20.0, 31), quintic), frame);
  const CostTerms many = cost_terms(cost_points(stations_over(context, 20.0, 601), quintic), frame);
  for (std::size_t i = 0; i < few.size(); ++i) {
    EXPECT_NEAR(few[i], many[i], 0.02 * (many[i] + 0.01)) << to_string(static_cast<CostTerm>(i));
  }
}

TEST(Cost, OfALaneChangeIsOfOrderOneInEveryCurvatureTerm) {
  const tests::AnalyticLine straight;
  const LineView view = straight.view();
  const std::function<double(double)> none;
  const CycleContext context{.line = view,
                             .start = {},
                             .speed = PlannedSpeed({10.0, 0.0, 10.0}),
                             .previous_d_m = none,
                             .half_width_m = 0.8,
                             .recovery_m = 10.0};
  const auto points =
      cost_points(stations_over(context, 20.0, 31), QuinticFamily(context.start, 20.0).member(3.5));
  for (const double term : {curvature_term(points), curvature_rate_term(points),
                            curvature_second_term(points), curvature_third_term(points)}) {
    EXPECT_GT(term, 0.1);
    EXPECT_LT(term, 3.0);
  }
}

TEST(Cost, TotalIsTheWeightedSum) {
  CostTerms terms{}, weights{};
  for (std::size_t i = 0; i < terms.size(); ++i) {
    terms[i] = static_cast<double>(i + 1);
    weights[i] = static_cast<double>(12 - i);
  }
  EXPECT_EQ(total_cost(terms, weights), 364.0);  // Σ i (13 − i)
}

TEST(Cost, RefusesWeightsThatAreNegativeOrNotFinite) {
  CostTerms weights = default_weights();
  EXPECT_NO_THROW(check_weights(weights));
  of(weights, CostTerm::offset) = -0.1;
  EXPECT_THROW(check_weights(weights), std::invalid_argument);
  of(weights, CostTerm::offset) = std::numeric_limits<double>::infinity();
  EXPECT_THROW(check_weights(weights), std::invalid_argument);
}

}  // namespace
}  // namespace roadbed::planning
