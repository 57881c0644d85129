#include "roadbed/geometry/curves/transverse_mercator.h"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <complex>
#include <numbers>
#include <stdexcept>

namespace roadbed::geometry::inline curves {
namespace {

using Series = std::array<double, 6>;

constexpr double kEquatorialRadius_m = 6378137.0;
constexpr double kFlattening = 1.0 / 298.257223563;
constexpr double n = kFlattening / (2.0 - kFlattening);  // third flattening
constexpr double n2 = n * n, n3 = n2 * n, n4 = n2 * n2, n5 = n4 * n, n6 = n3 * n3;

// Radius of the circle as long as a meridian, eq. 14.
constexpr double kRectifyingRadius_m =
    kEquatorialRadius_m / (1.0 + n) * (1.0 + n2 / 4.0 + n4 / 64.0 + n6 / 256.0);

// Eq. 35.
constexpr Series kAlpha = {
    n / 2.0 - 2.0 / 3.0 * n2 + 5.0 / 16.0 * n3 + 41.0 / 180.0 * n4 - 127.0 / 288.0 * n5 +
        7891.0 / 37800.0 * n6,
    13.0 / 48.0 * n2 - 3.0 / 5.0 * n3 + 557.0 / 1440.0 * n4 + 281.0 / 630.0 * n5 -
        1983433.0 / 1935360.0 * n6,
    61.0 / 240.0 * n3 - 103.0 / 140.0 * n4 + 15061.0 / 26880.0 * n5 + 167603.0 / 181440.0 * n6,
    49561.0 / 161280.0 * n4 - 179.0 / 168.0 * n5 + 6601661.0 / 7257600.0 * n6,
    34729.0 / 80640.0 * n5 - 3418889.0 / 1995840.0 * n6,
    212378941.0 / 319334400.0 * n6};

// Eq. 36.
constexpr Series kBeta = {
    n / 2.0 - 2.0 / 3.0 * n2 + 37.0 / 96.0 * n3 - 1.0 / 360.0 * n4 - 81.0 / 512.0 * n5 +
        96199.0 / 604800.0 * n6,
    1.0 / 48.0 * n2 + 1.0 / 15.0 * n3 - 437.0 / 1440.0 * n4 + 46.0 / 105.0 * n5 -
        1118711.0 / 3870720.0 * n6,
    17.0 / 480.0 * n3 - 37.0 / 840.0 * n4 - 209.0 / 4480.0 * n5 + 5569.0 / 90720.0 * n6,
    4397.0 / 161280.0 * n4 - 11.0 / 504.0 * n5 - 830251.0 / 7257600.0 * n6,
    4583.0 / 161280.0 * n5 - 108847.0 / 3991680.0 * n6,
    20648693.0 / 638668800.0 * n6};

const double kEccentricity = std::sqrt(kFlattening * (2.0 - kFlattening));

// Σ cⱼ sin 2jζ for complex ζ, by Clenshaw's summation.
std::complex<double> sine_series(const Series& coefficients, std::complex<double> zeta) {
  const double c = std::cos(2.0 * zeta.real()), s = std::sin(2.0 * zeta.real());
  const double grown = std::exp(2.0 * zeta.imag()), shrunk = 1.0 / grown;
  const double ch = 0.5 * (grown + shrunk), sh = 0.5 * (grown - shrunk);
  const double twice_re = 2.0 * c * ch, twice_im = -2.0 * s * sh;  // 2 cos 2ζ
  double re = 0.0, im = 0.0, last_re = 0.0, last_im = 0.0;
  for (std::size_t j = coefficients.size(); j-- > 0;) {
    const double next_re = coefficients[j] + twice_re * re - twice_im * im - last_re;
    const double next_im = twice_re * im + twice_im * re - last_im;
    last_re = re;
    last_im = im;
    re = next_re;
    im = next_im;
  }
  const double sin_re = s * ch, sin_im = c * sh;
  return {re * sin_re - im * sin_im, re * sin_im + im * sin_re};
}

// Tangent of the conformal latitude from that of the latitude, eqs. 7–9.
double conformal_tangent(double tau) {
  const double root = std::sqrt(1.0 + tau * tau);
  const double sigma = std::sinh(kEccentricity * std::atanh(kEccentricity * tau / root));
  return tau * std::sqrt(1.0 + sigma * sigma) - sigma * root;
}

// Its inverse by Newton's method, eqs. 19–21.
double geographic_tangent(double conformal) {
  const double e2 = kEccentricity * kEccentricity;
  double tau = conformal / std::sqrt(1.0 - e2);
  for (int i = 0; i < 5; ++i) {
    const double at = conformal_tangent(tau);
    const double step = (conformal - at) / std::hypot(1.0, at) * (1.0 + (1.0 - e2) * tau * tau) /
                        ((1.0 - e2) * std::hypot(1.0, tau));
    tau += step;
    if (!(std::abs(step) > 1e-16 * std::abs(tau))) break;
  }
  return tau;
}

// Northing over k₀A of a latitude on the central meridian.
double rectifying_latitude(double latitude_rad) {
  const double conformal = std::atan(conformal_tangent(std::tan(latitude_rad)));
  return conformal + sine_series(kAlpha, {conformal, 0.0}).real();
}

double origin_northing_m(const TransverseMercator& grid) {
  if (grid.latitude_of_origin_rad == 0.0) return 0.0;
  return grid.scale * kRectifyingRadius_m * rectifying_latitude(grid.latitude_of_origin_rad);
}

}  // namespace

Eigen::Vector2d TransverseMercator::forward(const GeographicPoint& point) const {
  const double lambda = point.longitude_rad - central_meridian_rad;
  const double tangent = conformal_tangent(std::tan(point.latitude_rad));
  const double cosine = std::cos(lambda);
  // The spherical transverse Mercator of the conformal latitude, eq. 10, then the series, eq. 11.
  std::complex<double> zeta(
      std::atan2(tangent, cosine),
      std::asinh(std::sin(lambda) / std::sqrt(tangent * tangent + cosine * cosine)));
  zeta += sine_series(kAlpha, zeta);
  const double radius_m = scale * kRectifyingRadius_m;
  return {false_easting_m + radius_m * zeta.imag(),
          false_northing_m + radius_m * zeta.real() - origin_northing_m(*this)};
}

GeographicPoint TransverseMercator::inverse(const Eigen::Vector2d& easting_northing_m) const {
  const double radius_m = scale * kRectifyingRadius_m;
  const double north_m = easting_northing_m.y() - false_northing_m + origin_northing_m(*this);
  std::complex<double> zeta(north_m / radius_m,
                            (easting_northing_m.x() - false_easting_m) / radius_m);
  zeta -= sine_series(kBeta, zeta);
  const double sinh_eta = std::sinh(zeta.imag()), cos_xi = std::cos(zeta.real());
  const double conformal = std::sin(zeta.real()) / std::hypot(sinh_eta, cos_xi);
  return {std::atan(geographic_tangent(conformal)),
          central_meridian_rad + std::atan2(sinh_eta, cos_xi)};
}

int utm_zone(const GeographicPoint& point) {
  constexpr double degree = std::numbers::pi / 180.0;
  const double latitude = point.latitude_rad / degree;
  double longitude = std::remainder(point.longitude_rad / degree, 360.0);
  if (longitude >= 180.0) longitude -= 360.0;
  if (latitude >= 56.0 && latitude < 64.0 && longitude >= 3.0 && longitude < 12.0) return 32;
  if (latitude >= 72.0 && latitude < 84.0 && longitude >= 0.0 && longitude < 42.0) {
    return 31 + 2 * static_cast<int>((longitude + 3.0) / 12.0);
  }
  return static_cast<int>((longitude + 180.0) / 6.0) + 1;
}

TransverseMercator utm_grid(int zone, bool south) {
  if (zone < 1 || zone > 60) {
    throw std::invalid_argument(fmt::format("utm_grid: zone must be 1 to 60, got {}", zone));
  }
  return {.central_meridian_rad = (6.0 * zone - 183.0) * std::numbers::pi / 180.0,
          .latitude_of_origin_rad = 0.0,
          .scale = 0.9996,
          .false_easting_m = 500'000.0,
          .false_northing_m = south ? 10'000'000.0 : 0.0};
}

}  // namespace roadbed::geometry::curves
