#include "roadbed/geometry/curves/cubic_spline.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>
#include <limits>
#include <random>
#include <stdexcept>
#include <vector>

namespace roadbed::geometry {
namespace {

struct Samples {
  std::vector<double> x, y;
};

Samples random_samples(std::mt19937& random, int count) {
  std::uniform_real_distribution<double> step(0.3, 2.0), value(-5.0, 5.0);
  Samples samples;
  double x = value(random);
  for (int i = 0; i < count; ++i, x += step(random)) {
    samples.x.push_back(x);
    samples.y.push_back(value(random));
  }
  return samples;
}

enum class Ends { natural, clamped, periodic };

// All 4·N coefficients from one dense system of their defining conditions.
class DenseSpline {
 public:
  DenseSpline(const Samples& samples, Ends ends, double first_slope, double last_slope)
      : x_(samples.x), pieces_(static_cast<int>(samples.x.size()) - 1) {
    matrix_ = Eigen::MatrixXd::Zero(4 * pieces_, 4 * pieces_);
    right_ = Eigen::VectorXd::Zero(4 * pieces_);
    for (int i = 0; i < pieces_; ++i) {
      condition({{i, 0.0, 0, 1.0}}, samples.y[index(i)]);
      condition({{i, width(i), 0, 1.0}}, samples.y[index(i + 1)]);
    }
    for (int i = 0; i + 1 < pieces_; ++i) join(i, i + 1);
    const int last = pieces_ - 1;
    if (ends == Ends::natural) {
      condition({{0, 0.0, 2, 1.0}}, 0.0);
      condition({{last, width(last), 2, 1.0}}, 0.0);
    } else if (ends == Ends::clamped) {
      condition({{0, 0.0, 1, 1.0}}, first_slope);
      condition({{last, width(last), 1, 1.0}}, last_slope);
    } else {
      join(last, 0);
    }
    solution_ = matrix_.fullPivLu().solve(right_);
  }

  double derivative(double x, int order) const {
    int i = 0;
    while (i + 1 < pieces_ && x >= x_[index(i + 1)]) ++i;
    double sum = 0.0;
    for (int power = 0; power < 4; ++power) {
      sum += solution_(4 * i + power) * term(x - x_[index(i)], power, order);
    }
    return sum;
  }

 private:
  struct Part {
    int piece;
    double t;
    int order;
    double sign;
  };

  static std::size_t index(int i) { return static_cast<std::size_t>(i); }
  double width(int i) const { return x_[index(i + 1)] - x_[index(i)]; }

  static double term(double t, int power, int order) {
    double factor = 1.0;
    for (int k = 0; k < order; ++k) factor *= power - k;
    return factor == 0.0 ? 0.0 : factor * std::pow(t, power - order);
  }

  void condition(const std::vector<Part>& parts, double value) {
    for (const Part& part : parts) {
      for (int power = 0; power < 4; ++power) {
        matrix_(row_, 4 * part.piece + power) += part.sign * term(part.t, power, part.order);
      }
    }
    right_(row_++) = value;
  }

  void join(int before, int after) {
    for (const int order : {1, 2}) {
      condition({{before, width(before), order, 1.0}, {after, 0.0, order, -1.0}}, 0.0);
    }
  }

  std::vector<double> x_;
  int pieces_ = 0;
  int row_ = 0;
  Eigen::MatrixXd matrix_;
  Eigen::VectorXd right_, solution_;
};

void expect_same(const CubicSpline& spline, const DenseSpline& dense, const Samples& samples) {
  for (int k = 0; k <= 200; ++k) {
    const double x =
        samples.x.front() + (samples.x.back() - samples.x.front()) * (k + 0.37) / 201.0;
    for (int order = 0; order <= 3; ++order) {
      ASSERT_NEAR(spline.derivative(x, order), dense.derivative(x, order), 1e-8)
          << "order " << order << " at " << x;
    }
  }
}

TEST(CubicSpline, AgreesWithADenseSolveForEveryKindOfEnd) {
  std::mt19937 random(20261121);
  for (int trial = 0; trial < 40; ++trial) {
    Samples samples = random_samples(random, 4 + trial % 9);
    expect_same(CubicSpline::natural(samples.x, samples.y),
                DenseSpline(samples, Ends::natural, 0, 0), samples);
    expect_same(CubicSpline::clamped(samples.x, samples.y, 1.5, -0.7),
                DenseSpline(samples, Ends::clamped, 1.5, -0.7), samples);
    samples.y.back() = samples.y.front();
    expect_same(CubicSpline::periodic(samples.x, samples.y),
                DenseSpline(samples, Ends::periodic, 0, 0), samples);
  }
}

TEST(CubicSpline, ClampedReproducesACubic) {
  const auto cubic = [](double x) { return 2.0 - x + 0.5 * x * x - 0.25 * x * x * x; };
  const auto slope = [](double x) { return -1.0 + x - 0.75 * x * x; };
  const std::vector<double> x{-1.0, 0.2, 1.0, 3.5};
  std::vector<double> y;
  for (const double at : x) y.push_back(cubic(at));
  const CubicSpline spline = CubicSpline::clamped(x, y, slope(x.front()), slope(x.back()));
  for (double at = -1.0; at <= 3.5; at += 0.01) {
    EXPECT_NEAR(spline.at(at), cubic(at), 1e-12);
    EXPECT_NEAR(spline.derivative(at, 1), slope(at), 1e-12);
  }
}

TEST(CubicSpline, GoesStraightThroughTwoPoints) {
  const CubicSpline spline = CubicSpline::natural({1.0, 3.0}, {5.0, 1.0});
  EXPECT_NEAR(spline.at(2.0), 3.0, 1e-15);
  EXPECT_NEAR(spline.derivative(2.5, 1), -2.0, 1e-15);
}

TEST(CubicSpline, RefusesKnotsThatDoNotIncreaseOrAreNotFinite) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(CubicSpline::natural({0.0}, {0.0}), std::invalid_argument);
  EXPECT_THROW(CubicSpline::natural({0.0, 1.0}, {0.0}), std::invalid_argument);
  EXPECT_THROW(CubicSpline::natural({0.0, 0.0}, {0.0, 1.0}), std::invalid_argument);
  EXPECT_THROW(CubicSpline::clamped({0.0, nan}, {0.0, 1.0}, 0.0, 0.0), std::invalid_argument);
  EXPECT_THROW(CubicSpline::natural({0.0, 1.0}, {nan, 1.0}), std::invalid_argument);
  EXPECT_THROW(CubicSpline::periodic({0.0, 1.0, 2.0}, {0.0, 1.0, 0.0}), std::invalid_argument);
  EXPECT_THROW(CubicSpline::periodic({0.0, 1.0, 2.0, 3.0}, {0.0, 1.0, 0.0, 0.1}),
               std::invalid_argument);
  EXPECT_THROW(CubicSpline::natural({0.0, 1.0}, {0.0, 1.0}).derivative(0.5, 4),
               std::invalid_argument);
}

}  // namespace
}  // namespace roadbed::geometry
