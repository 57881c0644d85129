#pragma once

#include <Eigen/Core>

namespace roadbed::map::inline files {

/// A place on the WGS 84 ellipsoid.
struct GeographicPoint {
  double latitude_deg = 0.0;
  double longitude_deg = 0.0;
};

/// Conformal map of the WGS 84 ellipsoid that keeps its scale along a meridian: UTM and its kin.
///
/// GeographicLib's: Krüger's series in the third flattening to the sixth order, [Karney 2011,
/// doi:10.1007/s00190-011-0445-3], within 5 nm up to 3,900 km from the central meridian.
struct TransverseMercator {
  double central_meridian_deg = 0.0;
  double latitude_of_origin_deg = 0.0;  ///< northing is the false one there; −90 to 90
  double scale = 1.0;                   ///< along the central meridian
  double false_easting_m = 0.0, false_northing_m = 0.0;

  /// Whether a place is within 60° of the central meridian: farther, lengths are over twice as
  /// long, and a quarter of the equator away there is no finite place.
  bool reaches(const GeographicPoint& point) const;

  /// Easting and northing [m] of a place that it reaches, of latitude −90 to 90.
  Eigen::Vector2d forward(const GeographicPoint& point) const;

  /// The inverse of `forward`; longitudes are −180 to 180.
  GeographicPoint inverse(const Eigen::Vector2d& easting_northing_m) const;
};

/// Zone of the Universal Transverse Mercator grid, 1 to 60, with the wider zones of Norway and
/// Svalbard.
int utm_zone(const GeographicPoint& point);

/// The grid of a zone; `south` adds the false northing of 10,000 km.
/// @throws std::invalid_argument if the zone is not 1 to 60.
TransverseMercator utm_grid(int zone, bool south);

/// Its number in the EPSG registry: 32632, 32732 in the south.
int epsg_of_utm(int zone, bool south);

}  // namespace roadbed::map::files
