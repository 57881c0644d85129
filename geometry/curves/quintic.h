#pragma once

#include <array>

namespace roadbed::geometry::inline curves {

/// Value, slope and second derivative at one end of a polynomial.
struct BoundaryState {
  double value = 0.0;
  double slope = 0.0;
  double second = 0.0;
};

/// The polynomial of degree five between two boundary states, paper eq. 13–22 with l_0 = 0:
/// P(l) = α0 + α1 l + … + α5 l⁵ on [0, L]. It is linear in the boundary states: the sum of two
/// quintics over the same length is the quintic of the summed states.
class Quintic {
 public:
  /// P and its first five derivatives with respect to l, in this order.
  using Derivatives = std::array<double, 6>;

  /// @throws std::invalid_argument if `length` is not finite and positive or a state not finite.
  Quintic(const BoundaryState& start, const BoundaryState& end, double length);

  /// @param l  any number; outside [0, length()] the polynomial goes on as it is.
  Derivatives at(double l) const;

  /// α0 … α5.
  const std::array<double, 6>& coefficients() const { return c_; }
  double length() const { return length_; }

 private:
  std::array<double, 6> c_;
  double length_;
};

}  // namespace roadbed::geometry::curves
