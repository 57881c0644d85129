#pragma once

#include <Eigen/Core>
#include <string>
#include <string_view>
#include <vector>

#include "roadbed/map/elements/attributes.h"

namespace roadbed::map::lane_table {

using Line3 = std::vector<Eigen::Vector3d>;

/// A feature: a line, or the outer ring of a polygon without its last point, and its columns.
struct Row {
  std::string id;  ///< the source's own, else its number from 1
  Line3 points;    ///< x, y and z; z is 0 where there is none
  bool is_ring = false;
  Attributes values;  ///< by column, as text; those without a value are left out

  /// What a column says; empty if nothing.
  std::string_view value(std::string_view column) const;
};

/// The features of a file, or of one layer of it.
struct Table {
  bool in_degrees = false;  ///< longitude and latitude
  std::string crs;          ///< of metres, as far as it is known
  std::vector<Row> rows;
  std::size_t unused = 0;  ///< features of other shapes
};

/// @throws InputError if it is no GeoJSON, or a position is none.
Table read_geojson(const std::string& bytes, const std::string& name);

/// Whether bytes are a database of SQLite.
bool is_geopackage(std::string_view bytes);

/// A layer of a GeoPackage (OGC 12-128r18).
/// @param layer  empty: the only one. Views are not read: they may ask for any work.
/// @throws InputError if it is none, there is no such layer, or a shape is broken.
Table read_geopackage(std::string bytes, const std::string& name, const std::string& layer);

}  // namespace roadbed::map::lane_table
