#pragma once

#include <optional>
#include <string_view>

namespace roadbed::map::inline files {

/// The units of a coordinate reference system's axes.
struct CrsUnits {
  bool is_in_degrees = false;            ///< longitude and latitude
  std::optional<double> horizontal_m{};  ///< one unit of a projected system's x and y [m]
  std::optional<double> vertical_m{};    ///< one unit of its heights [m]
};

/// What well-known text says of them, WKT 1 [OGC 01-009] or WKT 2 [ISO 19162]; nothing where it
/// does not, or is no such text. Needs no PROJ. O(text).
CrsUnits units_of_wkt(std::string_view text);

}  // namespace roadbed::map::files
