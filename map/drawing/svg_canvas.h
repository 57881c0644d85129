#pragma once

#include <Eigen/Core>
#include <span>
#include <string>
#include <string_view>

#include "roadbed/geometry/polygons/polygon.h"

namespace roadbed::map::inline drawing {

/// Collects path data and elements of an SVG picture whose unit is a metre; y grows downwards, so
/// that what is north in the map is up in the picture.
class SvgCanvas {
 public:
  /// @param upper_left_in_map  becomes the picture's origin.
  /// @param tolerance_m        lines are drawn to within this distance.
  SvgCanvas(const Eigen::Vector2d& upper_left_in_map, double tolerance_m)
      : upper_left_in_map_(upper_left_in_map), tolerance_m_(tolerance_m) {}

  Eigen::Vector2d to_picture(const Eigen::Vector2d& in_map) const;

  /// Path data ("M… L…") of an open line, of a closed ring, of a region with holes.
  std::string line(std::span<const Eigen::Vector2d> points_in_map) const;
  std::string ring(const geometry::Ring& ring_in_map) const;
  std::string region(std::span<const geometry::Polygon> polygons_in_map) const;

  /// Adds a path, if there is any data; `attributes` is written as it stands.
  void add_path(std::string_view data, std::string_view attributes);

  /// Adds any element as it stands.
  void add(std::string_view element);

  const std::string& elements() const { return elements_; }

 private:
  Eigen::Vector2d upper_left_in_map_;
  double tolerance_m_;
  std::string elements_;
};

}  // namespace roadbed::map::drawing
