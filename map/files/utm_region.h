#pragma once

#include <Eigen/Core>
#include <string>

#include "roadbed/map/files/transverse_mercator.h"

namespace roadbed::map::inline files {

/// "EPSG:32632", "EPSG:32732" in the south.
std::string crs_of_utm(int zone, bool south);

/// The plane for a file of longitudes and latitudes of one region: the UTM grid of its first place.
class UtmRegion {
 public:
  /// @param first_deg  longitude and latitude.
  explicit UtmRegion(const Eigen::Vector2d& first_deg);

  const std::string& crs() const { return crs_; }
  const TransverseMercator& grid() const { return grid_; }

  /// Easting and northing [m] of a longitude and latitude [°].
  /// @throws InputError naming `file` and `element` if it is over 60° from the zone, where lengths
  ///         are twice as long.
  Eigen::Vector2d metres_of(const Eigen::Vector2d& degrees, const std::string& file,
                            const std::string& element) const;

 private:
  TransverseMercator grid_;
  std::string crs_;
};

}  // namespace roadbed::map::files
