#pragma once

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "roadbed/geometry/curves/quadrature.h"

namespace roadbed::geometry::inline curves {

/// Arc length of a curve p(u) and its inverse, from its speed |dp/du| > 0, which is smooth between
/// `parameters`. Both directions agree to rounding, so that u(s) turns a curve into one of unit
/// speed.
class ArcLength {
 public:
  ArcLength() = default;

  /// @param parameters  increasing, at least two.
  template <typename Speed>
  ArcLength(std::vector<double> parameters, const Speed& speed)
      : parameters_(std::move(parameters)), stations_m_(1, 0.0) {
    stations_m_.reserve(parameters_.size());
    for (std::size_t i = 0; i + 1 < parameters_.size(); ++i) {
      stations_m_.push_back(stations_m_.back() +
                            integrate(speed, parameters_[i], parameters_[i + 1]));
    }
  }

  double length_m() const { return stations_m_.back(); }
  const std::vector<double>& parameters() const { return parameters_; }
  const std::vector<double>& stations_m() const { return stations_m_; }

  /// Arc length from the first parameter to `u`, which is clamped.
  template <typename Speed>
  double station_at(double u, const Speed& speed) const {
    const double within = std::clamp(u, parameters_.front(), parameters_.back());
    const std::size_t i = piece(parameters_, within);
    return stations_m_[i] + integrate(speed, parameters_[i], within);
  }

  /// The parameter at arc length `s_m`, which is clamped: Newton's method in its piece, kept inside
  /// by bisection. O(log N).
  template <typename Speed>
  double parameter_at(double s_m, const Speed& speed) const {
    const double s = std::clamp(s_m, 0.0, length_m());
    const std::size_t i = piece(stations_m_, s);
    double low = parameters_[i], high = parameters_[i + 1];
    double u = low + (high - low) * (s - stations_m_[i]) / (stations_m_[i + 1] - stations_m_[i]);
    for (int iteration = 0; iteration < 50; ++iteration) {
      const double missing = s - stations_m_[i] - integrate(speed, parameters_[i], u);
      (missing > 0.0 ? low : high) = u;
      const double step = missing / speed(u);
      const double next = u + step;
      if (std::abs(step) <= 1e-14 * (1.0 + std::abs(u))) return std::clamp(next, low, high);
      u = next > low && next < high ? next : 0.5 * (low + high);
    }
    return u;
  }

 private:
  static std::size_t piece(const std::vector<double>& bounds, double value) {
    const auto after = std::upper_bound(bounds.begin() + 1, bounds.end() - 1, value);
    return static_cast<std::size_t>(after - bounds.begin()) - 1;
  }

  std::vector<double> parameters_;
  std::vector<double> stations_m_;
};

}  // namespace roadbed::geometry::curves
