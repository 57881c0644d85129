#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace roadbed::tools::inline files {

/// Points of a table.
struct PointTable {
  std::vector<Eigen::Vector2d> points;
  bool is_lon_lat = false;  ///< longitude (x) and latitude (y) in degrees, else in source
};

/// Reads points: a header line that names the columns `x_m` and `y_m` (or `x` and `y`), or, where
/// these are missing, `lon_deg` and `lat_deg`, then a row per point. Order is free; other columns
/// are ignored.
/// @throws InputError naming line and column; a file without a row is refused too.
PointTable read_point_table(const std::filesystem::path& file);

/// The same from bytes; `name` stands for the file in messages.
PointTable parse_point_table(std::string_view bytes, const std::string& name);

/// A pair of places to find a route between, as text: origin and destination.
struct OdRow {
  std::size_t line = 0;  ///< of the file, from 1
  std::string from, to;  ///< places as on the command line, see place.h
  std::string fault;     ///< why the row cannot be used; empty if it can
};

/// Reads pairs: a header line that names the columns `from` and `to` (others are ignored), then a
/// row per pair; fields that hold commas stand in quotes. Empty lines are left out; rows with more
/// or fewer fields than the header has get a fault.
/// @throws InputError if there is no such header or no row at all.
std::vector<OdRow> parse_od_csv(std::string_view bytes, const std::string& name);

}  // namespace roadbed::tools::files
