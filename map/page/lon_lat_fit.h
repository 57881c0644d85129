#pragma once

#include <Eigen/Geometry>
#include <functional>
#include <optional>
#include <span>
#include <vector>

namespace roadbed::map::inline page {

/// Longitude and latitude as polynomials of x and y, for a page that has no projection library:
///
///     value(x, y) = Σ_ij c_ij T_i(u) T_j(v),   u, v = x, y scaled from the box to [−1, 1]
///
/// T_i are Chebyshev polynomials; the coefficients come from values at Chebyshev's nodes
/// [Trefethen, Approximation Theory and Approximation Practice, 2013, chapter 3].
struct LonLatFit {
  Eigen::AlignedBox2d box;
  int terms = 0;                                    ///< in each direction
  std::vector<double> longitude_deg, latitude_deg;  ///< c_ij, j fastest
  double most_error_deg = 0.0;                      ///< seen at places between the nodes

  Eigen::Vector2d at(const Eigen::Vector2d& place) const;
};

/// Longitude (x) and latitude (y) in degrees in place of coordinates; may throw.
using ToLonLat = std::function<void(std::span<Eigen::Vector2d>)>;

/// Fits the projection within a box.
LonLatFit fit_lon_lat(const Eigen::AlignedBox2d& box, const ToLonLat& to_lon_lat);

}  // namespace roadbed::map::page
