#include "roadbed/map/files/utm_region.h"

#include <fmt/format.h>

#include "roadbed/map/files/input_error.h"

namespace roadbed::map::inline files {
namespace {

GeographicPoint geographic(const Eigen::Vector2d& degrees) { return {degrees.y(), degrees.x()}; }

}  // namespace

std::string crs_of_utm(int zone, bool south) {
  return fmt::format("EPSG:{}", epsg_of_utm(zone, south));
}

UtmRegion::UtmRegion(const Eigen::Vector2d& first_deg) {
  const int zone = utm_zone(geographic(first_deg));
  const bool south = first_deg.y() < 0.0;
  grid_ = utm_grid(zone, south);
  crs_ = crs_of_utm(zone, south);
}

Eigen::Vector2d UtmRegion::metres_of(const Eigen::Vector2d& degrees, const std::string& file,
                                     const std::string& element) const {
  if (grid_.reaches(geographic(degrees))) return grid_.forward(geographic(degrees));
  throw InputError({.file = file,
                    .element = element,
                    .found = fmt::format("longitude {} is over 60° from the UTM zone of the first "
                                         "place",
                                         degrees.x()),
                    .needed = "places of one region",
                    .remedy = "give each region a file of its own"});
}

}  // namespace roadbed::map::files
