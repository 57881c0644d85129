#include "roadbed/geometry/curves/smooth_curve.h"

namespace roadbed::geometry::inline curves {
namespace {

// (constant + linear t) · p(t)
SpanPolynomial times(double constant, double linear, const SpanPolynomial& p) {
  SpanPolynomial result{};
  for (std::size_t i = 0; i < kSplineOrder; ++i) {
    result[i] += constant * p[i];
    if (i + 1 < kSplineOrder) result[i + 1] += linear * p[i];
  }
  return result;
}

std::array<SpanPolynomial, kSplineOrder> make_basis() {
  std::array<SpanPolynomial, kSplineOrder> basis{};
  basis[0][0] = 1.0;
  for (std::size_t degree = 1; degree <= kSplineDegree; ++degree) {
    const auto lower = basis;
    const auto d = static_cast<double>(degree);
    for (std::size_t j = 0; j <= degree; ++j) {
      // ((t + d − j) lower[j−1] + (1 − t + j) lower[j]) / d
      const auto at = static_cast<double>(j);
      SpanPolynomial sum = times((1.0 + at) / d, -1.0 / d, lower[j]);
      if (j > 0) {
        const SpanPolynomial other = times((d - at) / d, 1.0 / d, lower[j - 1]);
        for (std::size_t i = 0; i < kSplineOrder; ++i) sum[i] += other[i];
      }
      basis[j] = sum;
    }
  }
  return basis;
}

}  // namespace

const std::array<SpanPolynomial, kSplineOrder>& cardinal_basis() {
  static const auto basis = make_basis();
  return basis;
}

double evaluate(const SpanPolynomial& polynomial, double t, int order) {
  double sum = 0.0;
  for (std::size_t i = kSplineOrder; i-- > static_cast<std::size_t>(order);) {
    double factor = 1.0;
    for (int k = 0; k < order; ++k) factor *= static_cast<double>(i) - k;
    sum = sum * t + factor * polynomial[i];
  }
  return sum;
}

}  // namespace roadbed::geometry::curves
