#include "roadbed/geometry/curves/quintic.h"

#include <fmt/format.h>

#include <cmath>
#include <stdexcept>

namespace roadbed::geometry::inline curves {
namespace {

bool is_finite(const BoundaryState& state) {
  return std::isfinite(state.value) && std::isfinite(state.slope) && std::isfinite(state.second);
}

}  // namespace

Quintic::Quintic(const BoundaryState& start, const BoundaryState& end, double length)
    : length_(length) {
  if (!(length > 0.0) || !std::isfinite(length)) {
    throw std::invalid_argument(
        fmt::format("Quintic: length must be finite and positive, got {}", length));
  }
  if (!is_finite(start) || !is_finite(end)) {
    throw std::invalid_argument("Quintic: a boundary state is not finite");
  }
  // Eq. 22 in closed form: what the start state, carried on over L, misses at the end; each
  // derivative is scaled by a power of L so that all three have the unit of P.
  const double L = length;
  const double missing = end.value - (start.value + (start.slope + 0.5 * start.second * L) * L);
  const double missing_slope = (end.slope - (start.slope + start.second * L)) * L;
  const double missing_second = (end.second - start.second) * L * L;
  const double L3 = L * L * L;
  c_ = {start.value,
        start.slope,
        0.5 * start.second,
        (10.0 * missing - 4.0 * missing_slope + 0.5 * missing_second) / L3,
        (-15.0 * missing + 7.0 * missing_slope - missing_second) / (L3 * L),
        (6.0 * missing - 3.0 * missing_slope + 0.5 * missing_second) / (L3 * L * L)};
}

Quintic::Derivatives Quintic::at(double l) const {
  const auto& [a0, a1, a2, a3, a4, a5] = c_;
  return {a0 + l * (a1 + l * (a2 + l * (a3 + l * (a4 + l * a5)))),
          a1 + l * (2.0 * a2 + l * (3.0 * a3 + l * (4.0 * a4 + l * 5.0 * a5))),
          2.0 * a2 + l * (6.0 * a3 + l * (12.0 * a4 + l * 20.0 * a5)),
          6.0 * a3 + l * (24.0 * a4 + l * 60.0 * a5),
          24.0 * a4 + l * 120.0 * a5,
          120.0 * a5};
}

}  // namespace roadbed::geometry::curves
