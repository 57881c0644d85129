#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <string_view>

namespace roadbed::map::inline files {

/// A square of 100 km of the Military Grid Reference System: its south-west corner in its zone of
/// the Universal Transverse Mercator grid.
struct MgrsSquare {
  int zone = 0;
  bool south = false;
  Eigen::Vector2d corner_m{0, 0};
};

/// The square that a code ("54SUE815501") names; none if it names none.
std::optional<MgrsSquare> mgrs_square(std::string_view code);

/// The code of a place of a zone's grid, with so many digits for each of easting and northing: 0
/// names the square of 100 km ("54SUE"), 3 one of 100 m. Empty beyond 84° north and 80° south. By
/// GeographicLib, as Autoware has it.
std::string mgrs_code(int zone, bool south, const Eigen::Vector2d& easting_northing_m, int digits);

}  // namespace roadbed::map::files
