#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <string>
#include <variant>
#include <vector>

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

}  // namespace roadbed::map::gis
