#pragma once

#include <array>
#include <type_traits>

namespace roadbed::geometry::inline curves {

/// Integral of a smooth function over [from, to] by Gauss and Legendre's seven points: exact for
/// polynomials up to degree 13. Its values may be arrays of Eigen's.
template <typename Function>
std::invoke_result_t<const Function&, double> integrate(const Function& function, double from,
                                                        double to) {
  constexpr std::array<double, 4> kNodes{0.0, 0.4058451513773971669, 0.7415311855993944399,
                                         0.9491079123427585245};
  constexpr std::array<double, 4> kWeights{0.4179591836734693878, 0.3818300505051189449,
                                           0.2797053914892766679, 0.1294849661688696933};
  const double middle = 0.5 * (from + to), half = 0.5 * (to - from);
  std::invoke_result_t<const Function&, double> sum = kWeights[0] * function(middle);
  for (std::size_t i = 1; i < kNodes.size(); ++i) {
    sum +=
        kWeights[i] * (function(middle - half * kNodes[i]) + function(middle + half * kNodes[i]));
  }
  return half * sum;
}

}  // namespace roadbed::geometry::curves
