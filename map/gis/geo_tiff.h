#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

namespace roadbed::map::inline gis {

/// One number for each square of a raster, row by row from the south.
struct RasterBand {
  std::string name;           ///< "highest_m"
  std::vector<float> values;  ///< NaN: there is none
};

/// Squares of plan view.
struct Raster {
  double cell_m = 1.0;                ///< side of a square
  Eigen::Vector2d corner{0.0, 0.0};   ///< of the square with the least x and y
  std::size_t columns = 0, rows = 0;  ///< along x, and along y
  std::vector<RasterBand> bands;
};

/// A raster as GeoTIFF 1.1 (OGC 19-008r4): a band of floats after the other, packed by Deflate, the
/// first row in the north. Names of bands, and NaN as the value of no data, stand in GDAL's tags.
/// Same raster, same bytes with one version of zlib.
/// @param epsg  of `epsg_code`, the projected system of the corner; none: the file names none.
/// @throws std::invalid_argument if a band has another size, there is none, or the raster has no
///         square or more than 4 GB.
std::string write_geotiff(const Raster& raster, const std::optional<int>& epsg);

}  // namespace roadbed::map::gis
