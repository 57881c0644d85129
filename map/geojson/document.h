#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <map>
#include <string>
#include <vector>

#include "roadbed/map/elements/attributes.h"

/// What a GeoJSON file says, before it becomes a map.
namespace roadbed::map::geojson {

/// Positions of a ring as they stand, a repeated last one taken off.
using Positions = std::vector<Eigen::Vector2d>;

struct PolygonRecord {
  std::vector<Positions> rings;  ///< the outer one first
  bool was_open = false;         ///< a ring does not end where it begins
};

struct FeatureRecord {
  std::size_t number = 0;  ///< from 1, in order of the file
  std::string id;          ///< as in the file, else its number
  Attributes properties;   ///< texts, numbers and truth values; lists and objects as JSON
  std::vector<PolygonRecord> polygons;
};

struct Document {
  bool in_degrees = true;  ///< longitude and latitude
  std::string crs;         ///< of metres, as the file names it; may be empty
  std::vector<FeatureRecord> features;
  std::map<std::string, std::size_t> unused;  ///< geometries of other kinds
};

/// @throws InputError if it is no GeoJSON, or a position is none.
Document parse(const std::string& bytes, const std::string& name);

}  // namespace roadbed::map::geojson
