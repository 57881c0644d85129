#pragma once

#include <array>
#include <cmath>
#include <cstddef>

namespace roadbed::tests {

/// A power series cut after its sixth coefficient, in long double: enough to differentiate five
/// times by plain arithmetic, as an oracle for closed forms.
struct PowerSeries {
  static constexpr std::size_t kOrder = 6;
  std::array<long double, kOrder> c{};

  long double& operator[](std::size_t i) { return c[i]; }
  long double operator[](std::size_t i) const { return c[i]; }
};

inline PowerSeries operator+(PowerSeries a, const PowerSeries& b) {
  for (std::size_t i = 0; i < PowerSeries::kOrder; ++i) a[i] += b[i];
  return a;
}

inline PowerSeries operator-(PowerSeries a, const PowerSeries& b) {
  for (std::size_t i = 0; i < PowerSeries::kOrder; ++i) a[i] -= b[i];
  return a;
}

inline PowerSeries operator*(const PowerSeries& a, const PowerSeries& b) {
  PowerSeries product;
  for (std::size_t i = 0; i < PowerSeries::kOrder; ++i) {
    for (std::size_t j = 0; i + j < PowerSeries::kOrder; ++j) product[i + j] += a[i] * b[j];
  }
  return product;
}

inline PowerSeries operator/(const PowerSeries& a, const PowerSeries& b) {
  PowerSeries quotient;
  for (std::size_t i = 0; i < PowerSeries::kOrder; ++i) {
    long double rest = a[i];
    for (std::size_t j = 0; j < i; ++j) rest -= quotient[j] * b[i - j];
    quotient[i] = rest / b[0];
  }
  return quotient;
}

inline PowerSeries square_root(const PowerSeries& a) {
  PowerSeries root;
  root[0] = std::sqrt(a[0]);
  for (std::size_t i = 1; i < PowerSeries::kOrder; ++i) {
    long double rest = a[i];
    for (std::size_t j = 1; j < i; ++j) rest -= root[j] * root[i - j];
    root[i] = rest / (2 * root[0]);
  }
  return root;
}

inline PowerSeries derivative(const PowerSeries& a) {
  PowerSeries result;
  for (std::size_t i = 1; i < PowerSeries::kOrder; ++i) {
    result[i - 1] = a[i] * static_cast<long double>(i);
  }
  return result;
}

/// Integral from the point of expansion on.
inline PowerSeries integral(const PowerSeries& a) {
  PowerSeries result;
  for (std::size_t i = 1; i < PowerSeries::kOrder; ++i) {
    result[i] = a[i - 1] / static_cast<long double>(i);
  }
  return result;
}

/// cos and sin of a series that begins with 0.
struct CosineAndSine {
  PowerSeries cosine, sine;
};
inline CosineAndSine cosine_and_sine(const PowerSeries& angle) {
  CosineAndSine result;
  result.cosine[0] = 1;
  const PowerSeries turn = derivative(angle);
  for (std::size_t i = 0; i + 1 < PowerSeries::kOrder; ++i) {
    const auto n = static_cast<long double>(i + 1);
    result.cosine[i + 1] = -(result.sine * turn)[i] / n;
    result.sine[i + 1] = (result.cosine * turn)[i] / n;
  }
  return result;
}

}  // namespace roadbed::tests
