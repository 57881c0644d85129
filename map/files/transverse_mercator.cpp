#include "roadbed/map/files/transverse_mercator.h"

#include <fmt/format.h>

#include <GeographicLib/TransverseMercator.hpp>
#include <GeographicLib/UTMUPS.hpp>
#include <array>
#include <cmath>
#include <initializer_list>
#include <numbers>
#include <stdexcept>
#include <utility>

namespace roadbed::map::inline files {
namespace {

constexpr double kEquator_m = 6378137.0, kFlattening = 1.0 / 298.257223563;

// From the equator and a central meridian, at scale 1 on the meridian.
const GeographicLib::TransverseMercator& unit_projection() {
  static const GeographicLib::TransverseMercator projection(kEquator_m, kFlattening, 1.0);
  return projection;
}

// The same to the last bit, off the poles and up to 90° from the meridian, without the convergence
// and the scale of the map there, which are a third of the library's time.
class ForwardSeries {
 public:
  Eigen::Vector2d operator()(double latitude_deg, double from_meridian_deg) const {
    const auto [sin_phi, cos_phi] = sine_and_cosine(latitude_deg);
    const auto [sin_lambda, cos_lambda] = sine_and_cosine(from_meridian_deg);
    // The tangent of the latitude, and of that on the conformal sphere.
    const double tau = sin_phi / cos_phi, secant = std::hypot(1.0, tau);
    const double sigma = std::sinh(eccentricity_ * std::atanh(eccentricity_ * (tau / secant)));
    const double conformal_tau = std::hypot(1.0, sigma) * tau - sigma * secant;
    const double xi = std::atan2(conformal_tau, cos_lambda);
    const double eta = std::asinh(sin_lambda / std::hypot(conformal_tau, cos_lambda));
    // Σ αₖ sin 2kζ of ζ = ξ + iη, by Clenshaw's summation.
    const double c = std::cos(2 * xi), s = std::sin(2 * xi);
    const double ch = std::cosh(2 * eta), sh = std::sinh(2 * eta);
    const Complex twice_cosine{2 * c * ch, -2 * s * sh};
    Complex sum{0.0, 0.0}, next{0.0, 0.0};
    for (std::size_t k = alpha_.size(); k > 0; k -= 2) {
      next = (twice_cosine * sum).minus(next).plus(alpha_[k - 1]);
      sum = (twice_cosine * next).minus(sum).plus(alpha_[k - 2]);
    }
    sum = Complex{s * ch, c * sh} * sum;
    return {radius_m_ * (eta + sum.imaginary), radius_m_ * (xi + sum.real)};
  }

 private:
  // Of finite numbers; the standard's product looks for others.
  struct Complex {
    double real, imaginary;
    Complex operator*(const Complex& by) const {
      return {real * by.real - imaginary * by.imaginary, real * by.imaginary + imaginary * by.real};
    }
    Complex minus(const Complex& less) const {
      return {real - less.real, imaginary - less.imaginary};
    }
    Complex plus(double more) const { return {real + more, imaginary}; }
  };

  // Exact at whole quarters of a turn.
  static std::pair<double, double> sine_and_cosine(double angle_deg) {
    const bool is_near_quarter = std::abs(angle_deg) > 45.0;
    const double quarter_deg = is_near_quarter ? std::copysign(90.0, angle_deg) : 0.0;
    const double rest_rad = (angle_deg - quarter_deg) * (std::numbers::pi / 180.0);
    const double s = std::sin(rest_rad), c = std::cos(rest_rad);
    if (!is_near_quarter) return {s, c};
    return angle_deg > 0.0 ? std::pair(c, -s) : std::pair(-c, s);
  }

  // From the highest power down.
  static double polynomial(std::initializer_list<double> coefficients, double x) {
    double value = 0.0;
    for (const double coefficient : coefficients) value = value * x + coefficient;
    return value;
  }

  // Of [Karney 2011], eqs. 14 and 35.
  static std::array<double, 6> alphas(double n) {
    const std::array<double, 6> factors = {
        polynomial({31564, -66675, 34440, 47250, -100800, 75600}, n),
        polynomial({-1983433, 863232, 748608, -1161216, 524160}, n),
        polynomial({670412, 406647, -533952, 184464}, n),
        polynomial({6601661, -7732800, 2230245}, n),
        polynomial({-13675556, 3438171}, n),
        212378941,
    };
    constexpr std::array<double, 6> divisors = {151200,  1935360, 725760,
                                                7257600, 7983360, 319334400};
    std::array<double, 6> alpha{};
    double power = n;
    for (std::size_t k = 0; k < alpha.size(); ++k, power *= n) {
      alpha[k] = power * factors[k] / divisors[k];
    }
    return alpha;
  }

  double n_ = kFlattening / (2.0 - kFlattening);  // third flattening
  double eccentricity_ = std::sqrt(kFlattening * (2.0 - kFlattening));
  double radius_m_ = polynomial({1, 4, 64, 256}, n_* n_) / (256 * (1 + n_)) * kEquator_m;
  std::array<double, 6> alpha_ = alphas(n_);
};

// Easting and northing of the unit projection.
Eigen::Vector2d unit_forward(double meridian_deg, const GeographicPoint& point) {
  static const ForwardSeries series;
  const double from_meridian_deg = point.longitude_deg - meridian_deg;
  const bool is_plain = std::abs(point.latitude_deg) < 90.0 &&
                        std::abs(point.longitude_deg) < 180.0 && std::abs(meridian_deg) < 180.0 &&
                        std::abs(from_meridian_deg) < 90.0;
  if (is_plain) return series(point.latitude_deg, from_meridian_deg);
  double east_m = 0.0, north_m = 0.0;
  unit_projection().Forward(meridian_deg, point.latitude_deg, point.longitude_deg, east_m, north_m);
  return {east_m, north_m};
}

double origin_northing_m(const TransverseMercator& grid) {
  if (grid.latitude_of_origin_deg == 0.0) return 0.0;
  return grid.scale * unit_forward(0.0, {grid.latitude_of_origin_deg, 0.0}).y();
}

}  // namespace

Eigen::Vector2d TransverseMercator::forward(const GeographicPoint& point) const {
  const Eigen::Vector2d unit_m = unit_forward(central_meridian_deg, point);
  return {false_easting_m + scale * unit_m.x(),
          false_northing_m + scale * unit_m.y() - origin_northing_m(*this)};
}

GeographicPoint TransverseMercator::inverse(const Eigen::Vector2d& easting_northing_m) const {
  const double north_m = easting_northing_m.y() - false_northing_m + origin_northing_m(*this);
  GeographicPoint point;
  unit_projection().Reverse(central_meridian_deg,
                            (easting_northing_m.x() - false_easting_m) / scale, north_m / scale,
                            point.latitude_deg, point.longitude_deg);
  return point;
}

int utm_zone(const GeographicPoint& point) {
  // Asked for UTM, as its standard is another grid beyond 84° north and 80° south.
  return GeographicLib::UTMUPS::StandardZone(point.latitude_deg, point.longitude_deg,
                                             GeographicLib::UTMUPS::UTM);
}

TransverseMercator utm_grid(int zone, bool south) {
  if (zone < 1 || zone > 60) {
    throw std::invalid_argument(fmt::format("utm_grid: zone must be 1 to 60, got {}", zone));
  }
  return {.central_meridian_deg = 6.0 * zone - 183.0,
          .latitude_of_origin_deg = 0.0,
          .scale = 0.9996,
          .false_easting_m = 500'000.0,
          .false_northing_m = south ? 10'000'000.0 : 0.0};
}

}  // namespace roadbed::map::files
