#include "roadbed/geometry/curves/frenet.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <random>
#include <vector>

namespace roadbed::geometry {
namespace {

using Real = long double;

// Reference line with κ(s) = c0 + c1 s + … + c4 s⁴; its heading is the integral of that.
struct Line {
  std::array<Real, 5> c;

  Real curvature(Real s) const { return c[0] + s * (c[1] + s * (c[2] + s * (c[3] + s * c[4]))); }
  Real heading(Real s) const {
    return s * (c[0] + s * (c[1] / 2 + s * (c[2] / 3 + s * (c[3] / 4 + s * c[4] / 5))));
  }
  CurvatureDerivatives at(Real s) const {
    return {static_cast<double>(curvature(s)),
            static_cast<double>(c[1] + s * (2 * c[2] + s * (3 * c[3] + s * 4 * c[4]))),
            static_cast<double>(2 * c[2] + s * (6 * c[3] + s * 12 * c[4])),
            static_cast<double>(6 * c[3] + s * 24 * c[4]), static_cast<double>(24 * c[4])};
  }
};

struct OffsetLine {
  Line line;
  Quintic offset;
  double s;
};

std::vector<OffsetLine> random_offset_lines(int count) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> unit(-1.0, 1.0);
  std::vector<OffsetLine> offset_lines;
  for (int i = 0; i < count; ++i) {
    const Line line{{0.1 * unit(random), 0.01 * unit(random), 1e-3 * unit(random),
                     1e-4 * unit(random), 1e-5 * unit(random)}};
    const Quintic offset({3.0 * unit(random), 0.2 * unit(random), 0.05 * unit(random)},
                         {3.0 * unit(random), 0.0, 0.0}, 15.0);
    offset_lines.push_back({line, offset, 2.0 + unit(random)});
  }
  return offset_lines;
}

// The candidate as a complex velocity dp/ds = (1 − κ d + i d′) e^{iψ} in long double, and its
// heading and stretch, from which everything else follows by numerical differentiation.
Real lateral(const Quintic& offset, Real s) {
  Real value = 0;
  for (std::size_t j = 6; j-- > 0;) value = value * s + static_cast<Real>(offset.coefficients()[j]);
  return value;
}
Real slope(const Quintic& offset, Real s) {
  Real value = 0;
  for (std::size_t j = 6; j-- > 1;) {
    value = value * s + static_cast<Real>(j) * static_cast<Real>(offset.coefficients()[j]);
  }
  return value;
}
Real along(const OffsetLine& p, Real s) { return 1 - p.line.curvature(s) * lateral(p.offset, s); }
Real stretch(const OffsetLine& p, Real s) { return std::hypot(along(p, s), slope(p.offset, s)); }
Real heading(const OffsetLine& p, Real s) {
  return p.line.heading(s) + std::atan2(slope(p.offset, s), along(p, s));
}

// Central difference of order eight, repeated: d/dσ = (1/stretch) d/ds.
template <typename Function>
Real derivative(const Function& f, Real s, Real step) {
  return (4 * (f(s + step) - f(s - step)) / 5 - (f(s + 2 * step) - f(s - 2 * step)) / 5 +
          4 * (f(s + 3 * step) - f(s - 3 * step)) / 105 -
          (f(s + 4 * step) - f(s - 4 * step)) / 280) /
         step;
}

TEST(OffsetCurve, CurvatureAndItsDerivativesAreThoseOfTheCurveItself) {
  int checked = 0;
  for (const OffsetLine& p : random_offset_lines(300)) {
    const auto exact = offset_curve(p.line.at(p.s), p.offset.at(p.s), 0.3);
    if (!exact) continue;
    ++checked;
    const Real step = 0.02L;
    const auto k = [&](Real s) {
      return derivative([&](Real u) { return heading(p, u); }, s, step) / stretch(p, s);
    };
    const auto k1 = [&](Real s) { return derivative(k, s, step) / stretch(p, s); };
    const auto k2 = [&](Real s) { return derivative(k1, s, step) / stretch(p, s); };
    const auto k3 = [&](Real s) { return derivative(k2, s, step) / stretch(p, s); };
    const Real s = static_cast<Real>(p.s);
    EXPECT_NEAR(exact->stretch, static_cast<double>(stretch(p, s)), 1e-14);
    EXPECT_NEAR(exact->curvature_per_m, static_cast<double>(k(s)), 1e-12);
    EXPECT_NEAR(exact->curvature_d1_per_m2, static_cast<double>(k1(s)), 1e-11);
    EXPECT_NEAR(exact->curvature_d2_per_m3, static_cast<double>(k2(s)), 1e-10);
    EXPECT_NEAR(exact->curvature_d3_per_m4, static_cast<double>(k3(s)), 1e-9);
  }
  EXPECT_GT(checked, 250);
}

TEST(OffsetCurve, DirectionIsThatOfTheVelocity) {
  for (const OffsetLine& p : random_offset_lines(300)) {
    const auto exact = offset_curve(p.line.at(p.s), p.offset.at(p.s), 0.3);
    if (!exact) continue;
    const Real s = static_cast<Real>(p.s);
    const double angle = static_cast<double>(heading(p, s) - p.line.heading(s));
    EXPECT_NEAR(exact->along, std::cos(angle), 1e-14);
    EXPECT_NEAR(exact->across, std::sin(angle), 1e-14);
  }
}

TEST(OffsetCurve, BesideACircleIsACircle) {
  const auto left = offset_curve({0.1, 0, 0, 0, 0}, {2.0, 0, 0, 0, 0, 0}, 0.05);
  ASSERT_TRUE(left);
  EXPECT_NEAR(left->curvature_per_m, 0.125, 1e-15);  // radius 10 m, 2 m nearer to its centre
  EXPECT_NEAR(left->stretch, 0.8, 1e-15);
  EXPECT_NEAR(left->curvature_d1_per_m2, 0.0, 1e-15);
}

TEST(OffsetCurve, IsRejectedWhereTheOffsetReachesTheCentreOfCurvature) {
  EXPECT_TRUE(offset_curve({0.2, 0, 0, 0, 0}, {4.7, 0, 0, 0, 0, 0}, 0.05));
  EXPECT_FALSE(offset_curve({0.2, 0, 0, 0, 0}, {4.75, 0, 0, 0, 0, 0}, 0.05));
  EXPECT_FALSE(offset_curve({0.2, 0, 0, 0, 0}, {6.0, 0, 0, 0, 0, 0}, 0.05));
  EXPECT_FALSE(offset_curve({std::nan(""), 0, 0, 0, 0}, {0, 0, 0, 0, 0, 0}, 0.05));
}

TEST(Mixed, MakesSpeedAndTurnQuadraticInAParameterOfTheOffset) {
  for (const OffsetLine& p : random_offset_lines(100)) {
    const auto line = p.line.at(p.s);
    const auto d0 = p.offset.at(p.s), d1 = Quintic({}, {.value = 1.0}, 15.0).at(p.s);
    const FrameVelocity u = frame_velocity(line, d0);
    FrameVelocity v = frame_velocity(line, d1);
    v.along[0] -= 1.0;  // only the part that is linear in the parameter
    const double e = 1.7;
    Quintic::Derivatives d;
    for (std::size_t i = 0; i < d.size(); ++i) d[i] = d0[i] + e * d1[i];
    const FrameVelocity z = frame_velocity(line, d);
    const SpeedAndTurn whole = mixed(line, z, z), uu = mixed(line, u, u), uv = mixed(line, u, v),
                       vu = mixed(line, v, u), vv = mixed(line, v, v);
    for (std::size_t i = 0; i < 4; ++i) {
      EXPECT_NEAR(whole.g[i], uu.g[i] + e * (uv.g[i] + vu.g[i] + e * vv.g[i]), 1e-12);
      EXPECT_NEAR(whole.q[i], uu.q[i] + e * (uv.q[i] + vu.q[i] + e * vv.q[i]), 1e-12);
    }
  }
}

}  // namespace
}  // namespace roadbed::geometry
