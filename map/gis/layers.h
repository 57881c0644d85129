#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "roadbed/map/model/road_map.h"

namespace roadbed::map::inline gis {

/// A value in a layer's column; monostate: the map does not say.
using Value =
    std::variant<std::monostate, bool, std::int64_t, double, std::string, std::vector<std::string>>;

/// What the values of a column are, in the order of Value's alternatives after the first.
enum class ColumnKind { truth, whole, number, text, list };

struct Column {
  std::string name;
  ColumnKind kind = ColumnKind::text;
};

enum class ShapeKind { point, line, polygon, multi_polygon };

using Points = std::vector<Eigen::Vector3d>;

/// Polygons of rings of points, the outer ring first and counter-clockwise, holes clockwise, the
/// first point not repeated; a line is one ring of one polygon, a point a line of one point. No
/// polygon: there is no place.
using Shape = std::vector<std::vector<Points>>;

/// The least box around a shape in plan; empty around one of no place.
Eigen::AlignedBox2d box_of(const Shape& shape);

/// A thing with a place and values, one per column of its layer.
struct Feature {
  Shape shape;
  std::vector<Value> values;
};

/// Things of one kind, as geographic information systems keep them.
struct Layer {
  std::string name;  ///< "lanes"
  std::string kind;  ///< of one feature: "lane"
  ShapeKind shape = ShapeKind::point;
  bool has_z = false;
  std::vector<Column> columns;
  std::vector<Feature> features;
};

/// Names of all layers, in the order in which they are drawn, the ground first: `areas`,
/// `area_centrelines`, `roads`, `junctions`, `drivable_surface`, `lanes`, `borders`, `centrelines`,
/// `objects`, `object_points`, `stop_lines`, `signals`, `findings`.
std::vector<std::string> layer_names();

/// One layer of a map, `in_map` coordinates.
/// @throws std::invalid_argument if there is no layer of that name.
Layer make_layer(const RoadMap& road_map, std::string_view name);

/// The named layers, or all if none is named, without those that would be empty and not named.
std::vector<Layer> make_layers(const RoadMap& road_map, std::span<const std::string> names = {});

/// Layers from `in_map` to the source's raw coordinates [m].
void to_source(const RoadMap& road_map, std::vector<Layer>& layers);

/// Layers from the source's raw coordinates to those of its coordinate reference system: turned and
/// moved by the map's offset (OpenDRIVE's header), heights moved.
void source_to_crs(const RoadMap& road_map, std::vector<Layer>& layers);

/// Layers from coordinates of a system to longitude and latitude (degrees, WGS 84), heights as
/// they stand. @throws InputError as `to_lon_lat` does.
void to_lon_lat(const std::string& crs, std::vector<Layer>& layers);

}  // namespace roadbed::map::gis
