#include "roadbed/map/page/lon_lat_fit.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace roadbed::map::inline page {
namespace {

using Eigen::Vector2d;

constexpr int kTerms = 8;

/// T_0 … T_7 at a place of [−1, 1].
std::array<double, kTerms> chebyshev(double u) {
  std::array<double, kTerms> values{1.0, u};
  for (std::size_t i = 2; i < kTerms; ++i) values[i] = 2.0 * u * values[i - 1] - values[i - 2];
  return values;
}

double node(int i) { return std::cos(std::numbers::pi * (i + 0.5) / kTerms); }

Vector2d place_of(const Eigen::AlignedBox2d& box, double u, double v) {
  return box.center() + 0.5 * box.sizes().cwiseProduct(Vector2d(u, v));
}

/// Coefficients of one of the two values at all pairs of nodes, by the polynomials' orthogonality.
std::vector<double> coefficients(const std::vector<Vector2d>& at_nodes, int axis) {
  std::vector<double> made(kTerms * kTerms, 0.0);
  for (int a = 0; a < kTerms; ++a) {
    for (int b = 0; b < kTerms; ++b) {
      const auto in_u = chebyshev(node(a)), in_v = chebyshev(node(b));
      const double value = at_nodes[static_cast<std::size_t>(a * kTerms + b)][axis];
      for (std::size_t i = 0; i < kTerms; ++i) {
        for (std::size_t j = 0; j < kTerms; ++j) {
          const double weight = (i == 0 ? 1.0 : 2.0) * (j == 0 ? 1.0 : 2.0) / (kTerms * kTerms);
          made[i * kTerms + j] += weight * value * in_u[i] * in_v[j];
        }
      }
    }
  }
  return made;
}

}  // namespace

Vector2d LonLatFit::at(const Vector2d& place) const {
  const Vector2d scaled = 2.0 * (place - box.center()).cwiseQuotient(box.sizes());
  const auto in_u = chebyshev(scaled.x()), in_v = chebyshev(scaled.y());
  Vector2d sum(0, 0);
  for (std::size_t i = 0; i < kTerms; ++i) {
    for (std::size_t j = 0; j < kTerms; ++j) {
      sum +=
          in_u[i] * in_v[j] * Vector2d(longitude_deg[i * kTerms + j], latitude_deg[i * kTerms + j]);
    }
  }
  return sum;
}

LonLatFit fit_lon_lat(const Eigen::AlignedBox2d& box, const ToLonLat& to_lon_lat) {
  std::vector<Vector2d> at_nodes, between;
  for (int a = 0; a < kTerms; ++a) {
    for (int b = 0; b < kTerms; ++b) {
      at_nodes.push_back(place_of(box, node(a), node(b)));
      between.push_back(
          place_of(box, -1.0 + 2.0 * a / (kTerms - 1), -1.0 + 2.0 * b / (kTerms - 1)));
    }
  }
  const std::vector<Vector2d> places = between;
  to_lon_lat(at_nodes);
  to_lon_lat(between);
  LonLatFit fit{box, kTerms, coefficients(at_nodes, 0), coefficients(at_nodes, 1), 0.0};
  for (std::size_t i = 0; i < places.size(); ++i) {
    const double error_deg = (fit.at(places[i]) - between[i]).cwiseAbs().maxCoeff();
    fit.most_error_deg = std::max(fit.most_error_deg, error_deg);
  }
  return fit;
}

}  // namespace roadbed::map::page
