#pragma once

#include <array>
#include <cmath>
#include <cstddef>

namespace roadbed::geometry::inline curves {

/// The first N Taylor coefficients of a function at one point, f(u₀ + ε) = Σ fₖ εᵏ. Sums and
/// products of functions become those of their series, so derivatives of long formulas need no
/// formula of their own.
template <std::size_t N>
using Taylor = std::array<double, N>;

/// Series of the product.
template <std::size_t N>
Taylor<N> product(const Taylor<N>& f, const Taylor<N>& g) {
  Taylor<N> result{};
  for (std::size_t n = 0; n < N; ++n) {
    for (std::size_t k = 0; k <= n; ++k) result[n] += f[k] * g[n - k];
  }
  return result;
}

/// Series of f^exponent, f₀ > 0: p f′ · exponent = p′ f, term by term.
template <std::size_t N>
Taylor<N> power(const Taylor<N>& f, double exponent) {
  Taylor<N> result{};
  result[0] = std::pow(f[0], exponent);
  for (std::size_t n = 1; n < N; ++n) {
    double sum = 0.0;
    for (std::size_t k = 1; k <= n; ++k) {
      sum += (static_cast<double>(k) * (exponent + 1.0) - static_cast<double>(n)) * f[k] *
             result[n - k];
    }
    result[n] = sum / (static_cast<double>(n) * f[0]);
  }
  return result;
}

/// Series of f′; the last coefficient is unknown and left out.
template <std::size_t N>
Taylor<N - 1> slope(const Taylor<N>& f) {
  Taylor<N - 1> result{};
  for (std::size_t n = 1; n < N; ++n) result[n - 1] = static_cast<double>(n) * f[n];
  return result;
}

/// The first M coefficients.
template <std::size_t M, std::size_t N>
Taylor<M> truncated(const Taylor<N>& f) {
  static_assert(M <= N);
  Taylor<M> result{};
  for (std::size_t n = 0; n < M; ++n) result[n] = f[n];
  return result;
}

}  // namespace roadbed::geometry::curves
