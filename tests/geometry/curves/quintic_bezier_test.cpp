#include "roadbed/geometry/curves/quintic_bezier.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <stdexcept>
#include <vector>

namespace roadbed::geometry {
namespace {

Eigen::Vector2d de_casteljau(std::array<Eigen::Vector2d, 6> points, double t) {
  for (std::size_t left = 5; left > 0; --left) {
    for (std::size_t j = 0; j < left; ++j) points[j] = (1.0 - t) * points[j] + t * points[j + 1];
  }
  return points[0];
}

QuinticBezier random_curve(std::mt19937& random) {
  std::uniform_real_distribution<double> coordinate(-10.0, 10.0);
  std::array<Eigen::Vector2d, 6> points;
  for (Eigen::Vector2d& point : points) point = {coordinate(random), coordinate(random)};
  return QuinticBezier(points);
}

TEST(QuinticBezier, AgreesWithDeCasteljau) {
  std::mt19937 random(20261121);
  for (int trial = 0; trial < 100; ++trial) {
    const QuinticBezier curve = random_curve(random);
    for (double t = 0.0; t <= 1.0; t += 0.05) {
      EXPECT_NEAR((curve.at(t) - de_casteljau(curve.control_points(), t)).norm(), 0.0, 1e-12);
    }
  }
}

TEST(QuinticBezier, EachDerivativeIsTheSlopeOfTheOneBefore) {
  std::mt19937 random(20261121);
  const double h = 1e-5;
  for (int trial = 0; trial < 20; ++trial) {
    const QuinticBezier curve = random_curve(random);
    for (int order = 1; order <= 6; ++order) {
      for (double t = 0.1; t < 0.95; t += 0.1) {
        const Eigen::Vector2d slope =
            (curve.derivative(t + h, order - 1) - curve.derivative(t - h, order - 1)) / (2.0 * h);
        EXPECT_NEAR((curve.derivative(t, order) - slope).norm(), 0.0, 1e-4) << "order " << order;
      }
    }
  }
}

// Heading and curvature of chords beside an end of the curve, by positions alone.
TEST(QuinticBezier, JoinsPlacesWithTheirHeadingsAndCurvatures) {
  const CurvePoint from{.position = {1.0, 2.0}, .heading_rad = 0.3, .curvature_per_m = {0.08}};
  const CurvePoint to{.position = {12.0, 9.0}, .heading_rad = 1.2, .curvature_per_m = {-0.05}};
  const QuinticBezier curve = QuinticBezier::joining(from, 2.5, to, 3.5);
  EXPECT_EQ(curve.at(0.0), from.position);
  EXPECT_EQ(curve.at(1.0), to.position);
  const double h = 1e-3;
  for (const CurvePoint* end : {&from, &to}) {
    const double t = end == &from ? 0.0 : 1.0;
    const Eigen::Vector2d a = curve.at(t - h), b = curve.at(t), c = curve.at(t + h);
    EXPECT_NEAR(std::atan2(c.y() - a.y(), c.x() - a.x()), end->heading_rad, 1e-5);
    const double turn =
        std::atan2(c.y() - b.y(), c.x() - b.x()) - std::atan2(b.y() - a.y(), b.x() - a.x());
    EXPECT_NEAR(turn / (0.5 * (c - a).norm()), end->curvature_per_m[0], 1e-4);
  }
  EXPECT_THROW(QuinticBezier::joining(from, 0.0, to, 1.0), std::invalid_argument);
}

struct Peaks {
  double curvature = 0.0, rate = 0.0;
  int humps = 0;
};

Peaks peaks_of(const QuinticBezier& curve) {
  Peaks peaks;
  const int count = 20000;
  std::vector<double> curvature;
  for (int i = 0; i <= count; ++i) {
    const double t = static_cast<double>(i) / count;
    curvature.push_back(std::abs(curve.curvature_per_m(t)));
    peaks.curvature = std::max(peaks.curvature, curvature.back());
    if (i == 0) continue;
    const double length = (curve.at(t) - curve.at(t - 1.0 / count)).norm();
    peaks.rate = std::max(peaks.rate, std::abs(curvature.back() - *(curvature.end() - 2)) / length);
  }
  for (std::size_t i = 1; i + 1 < curvature.size(); ++i) {
    if (curvature[i] > curvature[i - 1] && curvature[i] >= curvature[i + 1]) ++peaks.humps;
  }
  return peaks;
}

TEST(QuinticBezier, PaperGapsAtARightAngleGiveTwoHumpsOf013PerMetre) {
  const Peaks paper = peaks_of(QuinticBezier::corner({0, 0}, {20, 0}, {20, 20}, kPaperGaps));
  EXPECT_NEAR(paper.curvature, 0.130, 5e-4);
  EXPECT_NEAR(paper.rate, 0.142, 5e-4);
  EXPECT_EQ(paper.humps, 2);
  const Peaks gentle = peaks_of(QuinticBezier::corner({0, 0}, {20, 0}, {20, 20}, kGentleGaps));
  EXPECT_NEAR(gentle.curvature, 0.113, 5e-4);
  EXPECT_NEAR(gentle.rate, 0.0154, 1e-4);
  EXPECT_EQ(gentle.humps, 1);
}

TEST(QuinticBezier, ControlPointsLieOnTheLegsAtThePapersDistances) {
  const QuinticBezier curve = QuinticBezier::corner({0, 0}, {20, 0}, {20, -30});
  const std::array<Eigen::Vector2d, 6> expected{
      Eigen::Vector2d{6, 0}, {9, 0}, {12, 0}, {20, -8}, {20, -11}, {20, -14}};
  for (std::size_t j = 0; j < 6; ++j) {
    EXPECT_NEAR((curve.control_points()[j] - expected[j]).norm(), 0.0, 1e-12) << "P" << j;
  }
}

TEST(QuinticBezier, EqualFirstGapsJoinTheLegsWithoutCurvature) {
  std::mt19937 random(20261121);
  std::uniform_real_distribution<double> angle(-2.5, 2.5), gap(0.5, 6.0);
  for (int trial = 0; trial < 100; ++trial) {
    const double turn = angle(random), first = gap(random);
    const Eigen::Vector2d ahead(std::cos(turn), std::sin(turn));
    const QuinticBezier curve =
        QuinticBezier::corner({-50, 0}, {0, 0}, 50.0 * ahead, {first, first, gap(random)});
    EXPECT_NEAR(curve.derivative(0.0, 2).norm(), 0.0, 1e-10);
    EXPECT_NEAR(curve.derivative(1.0, 2).norm(), 0.0, 1e-10);
    EXPECT_NEAR((curve.derivative(0.0, 1).normalized() - Eigen::Vector2d(1, 0)).norm(), 0, 1e-12);
    EXPECT_NEAR((curve.derivative(1.0, 1).normalized() - ahead).norm(), 0.0, 1e-12);
    EXPECT_EQ(curve.curvature_per_m(0.5) > 0.0, turn > 0.0);
  }
}

TEST(QuinticBezier, LengthIsThatOfFineChords) {
  const QuinticBezier curve = QuinticBezier::corner({0, 0}, {20, 0}, {20, 20});
  double chords_m = 0.0;
  for (int i = 1; i <= 20000; ++i) {
    chords_m += (curve.at(i / 20000.0) - curve.at((i - 1) / 20000.0)).norm();
  }
  EXPECT_NEAR(curve.length_m(), chords_m, 1e-6);
}

TEST(QuinticBezier, RefusesGapsThatDoNotFit) {
  EXPECT_THROW(QuinticBezier::corner({0, 0}, {13, 0}, {13, 20}), std::invalid_argument);
  EXPECT_THROW(QuinticBezier::corner({0, 0}, {20, 0}, {20, 1}), std::invalid_argument);
  EXPECT_THROW(QuinticBezier::corner({0, 0}, {20, 0}, {20, 20}, {0, 3, 8}), std::invalid_argument);
  EXPECT_NO_THROW(QuinticBezier::corner({0, 0}, {2, 0}, {2, 2}, scaled_to(kPaperGaps, 2.0)));
}

}  // namespace
}  // namespace roadbed::geometry
