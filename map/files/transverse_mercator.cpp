#include "roadbed/map/files/transverse_mercator.h"

#include <fmt/format.h>

#include <GeographicLib/TransverseMercator.hpp>
#include <GeographicLib/UTMUPS.hpp>
#include <cmath>
#include <stdexcept>

namespace roadbed::map::inline files {
namespace {

// From the equator and a central meridian, at scale 1 on the meridian.
const GeographicLib::TransverseMercator& unit_projection() {
  static const GeographicLib::TransverseMercator projection(6378137.0, 1.0 / 298.257223563, 1.0);
  return projection;
}

double origin_northing_m(const TransverseMercator& grid) {
  if (grid.latitude_of_origin_deg == 0.0) return 0.0;
  double east_m = 0.0, north_m = 0.0;
  unit_projection().Forward(0.0, grid.latitude_of_origin_deg, 0.0, east_m, north_m);
  return grid.scale * north_m;
}

}  // namespace

bool TransverseMercator::reaches(const GeographicPoint& point) const {
  return std::abs(std::remainder(point.longitude_deg - central_meridian_deg, 360.0)) <= 60.0;
}

Eigen::Vector2d TransverseMercator::forward(const GeographicPoint& point) const {
  double east_m = 0.0, north_m = 0.0;
  unit_projection().Forward(central_meridian_deg, point.latitude_deg, point.longitude_deg, east_m,
                            north_m);
  return {false_easting_m + scale * east_m,
          false_northing_m + scale * north_m - origin_northing_m(*this)};
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

int epsg_of_utm(int zone, bool south) { return (south ? 32700 : 32600) + zone; }

}  // namespace roadbed::map::files
