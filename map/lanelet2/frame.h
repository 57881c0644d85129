#pragma once

#include <Eigen/Core>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "roadbed/map/files/transverse_mercator.h"

namespace roadbed::map::lanelet2 {

/// Where a node says that it is; NaN where it does not.
struct NodePlace {
  double latitude_deg, longitude_deg;
  double local_x_m, local_y_m;  ///< Autoware's tags

  bool is_local() const;     ///< has usable local coordinates
  bool is_on_earth() const;  ///< has a latitude and a longitude that exist
};

/// The one coordinate system of a file: Autoware's `local_x/local_y` where most nodes have them,
/// else UTM in the zone of the first node; nodes beyond the zone's edge stay in it.
class Frame {
 public:
  /// @param mgrs_code  of the first node that names its grid square; may be empty.
  /// @param threads    that may be used.
  Frame(std::span<const NodePlace> nodes, std::string_view mgrs_code, int threads = 1);

  /// Coordinates of a node; none if it has none that fit this frame, or impossible ones.
  std::optional<Eigen::Vector2d> place(const NodePlace& node) const;

  bool is_local() const { return local_; }

  /// EPSG code or PROJ string; empty if nothing in the file tells. Local coordinates have one where
  /// the nodes that also have lat/lon agree on it within 1 cm, or their MGRS square is known.
  const std::string& crs() const { return crs_; }

  /// Why the CRS of local coordinates is not known; empty if it is.
  const std::string& doubt() const { return doubt_; }

 private:
  void find_local_grid(std::span<const NodePlace> nodes, std::string_view mgrs_code, int threads);

  bool local_ = false;
  std::optional<TransverseMercator> grid_;  ///< shifted so that it yields local ones
  std::string crs_, doubt_;
};

/// A grid as text: an EPSG code where it is a zone of UTM, else a PROJ string, its shift in whole
/// millimetres.
std::string crs_text(const TransverseMercator& grid);

/// The grid that a CRS text names, where it is a transverse Mercator one on WGS 84 or GRS 80 (their
/// grids differ by less than 0.1 mm): "EPSG:326zz", "EPSG:327zz", "EPSG:258zz", "+proj=utm …",
/// "+proj=tmerc …". None for everything else; needs no PROJ.
std::optional<TransverseMercator> transverse_mercator_of(std::string_view crs);

}  // namespace roadbed::map::lanelet2
