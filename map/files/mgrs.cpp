#include "roadbed/map/files/mgrs.h"

#include <GeographicLib/MGRS.hpp>

namespace roadbed::map::inline files {

using GeographicLib::GeographicErr;
using GeographicLib::MGRS;

std::optional<MgrsSquare> mgrs_square(std::string_view code) {
  const std::size_t zone_digits = std::min(code.find_first_not_of("0123456789"), code.size());
  if (zone_digits == 0 || code.size() < zone_digits + 3) return {};
  MgrsSquare square;
  bool north = false;
  int digits = 0;
  try {
    MGRS::Reverse(std::string(code.substr(0, zone_digits + 3)), square.zone, north,
                  square.corner_m.x(), square.corner_m.y(), digits, false);
  } catch (const GeographicErr&) {
    return {};  // no such square
  }
  square.south = !north;
  return square;
}

std::string mgrs_code(int zone, bool south, const Eigen::Vector2d& easting_northing_m, int digits) {
  std::string code;
  try {
    MGRS::Forward(zone, !south, easting_northing_m.x(), easting_northing_m.y(), digits, code);
  } catch (const GeographicErr&) {
    return {};  // the grid has no squares there
  }
  return code;
}

}  // namespace roadbed::map::files
