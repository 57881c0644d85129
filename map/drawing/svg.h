#pragma once

#include <Eigen/Geometry>
#include <span>
#include <string>
#include <string_view>

#include "roadbed/geometry/polygons/polygon.h"

namespace roadbed::map::inline drawing {

/// "12.3": one decimal, no zeros at the end.
std::string svg_number(double value_px);

/// Where a part of the plane is in a picture: y grows upwards in the plane, downwards in the
/// picture. A picture's unit, here "px", is whatever its `viewBox` is counted in.
struct PictureFrame {
  Eigen::Vector2d centre_in_plane{0, 0};
  Eigen::Vector2d centre_px{0, 0};
  double px_per_m = 1.0;
  Eigen::Vector2d size_px{0, 0};  ///< of the picture, whose upper left corner is (0, 0)
  std::string (*number)(double) = svg_number;  ///< how coordinates of lines are written

  Eigen::Vector2d to_px(const Eigen::Vector2d& in_plane) const;

  /// Whether a box reaches into the picture; an empty one does not.
  bool shows(const Eigen::AlignedBox2d& box_in_plane) const;
};

/// Path data ("M… L…") of an open line, or of a closed ring, drawn to within a fifth of a pixel.
std::string svg_line(const PictureFrame& frame, std::span<const Eigen::Vector2d> points_in_plane);
std::string svg_ring(const PictureFrame& frame, std::span<const Eigen::Vector2d> points_in_plane);

/// Path data of a box that is upright in the picture.
std::string svg_box(const PictureFrame& frame, const Eigen::AlignedBox2d& box_in_plane);

/// `<path … d="…"/>` with attributes as they stand, or with a class; nothing if there is no data.
std::string svg_styled_path(std::string_view attributes, std::string_view data);
std::string svg_path(std::string_view css_class, std::string_view data);

/// Text at a place; its letters are escaped.
std::string svg_text(std::string_view css_class, const Eigen::Vector2d& at_px,
                     std::string_view text);

/// Width of a text in the proportions of usual sans-serif fonts [px]; those that are there may have
/// others, in which svg_text() is wider or narrower.
double usual_width_px(std::string_view text, double font_px);

/// Text that is `width_px` wide in any font, and so is cut in none: what a font lacks or has too
/// much is made up by its letters' widths.
std::string svg_text_of_width(std::string_view css_class, const Eigen::Vector2d& at_px,
                              std::string_view text, double width_px);

/// The largest of 1, 2, 5 × 10ⁿ metres that is no longer: what a scale bar shows.
double round_length_m(double longest_m);

/// Collects path data and elements of a picture whose unit is a metre, with two decimals.
class SvgCanvas {
 public:
  /// @param upper_left_in_map  becomes the picture's origin.
  /// @param tolerance_m        lines are drawn to within this distance.
  SvgCanvas(const Eigen::Vector2d& upper_left_in_map, double tolerance_m);

  Eigen::Vector2d to_picture(const Eigen::Vector2d& in_map) const { return frame_.to_px(in_map); }

  /// Path data of an open line, of a closed ring, of a region with holes.
  std::string line(std::span<const Eigen::Vector2d> points_in_map) const;
  std::string ring(const geometry::Ring& ring_in_map) const;
  std::string region(std::span<const geometry::Polygon> polygons_in_map) const;

  /// Adds a path, if there is any data; `attributes` is written as it stands.
  void add_path(std::string_view data, std::string_view attributes);

  /// Adds any element as it stands.
  void add(std::string_view element);

  const std::string& elements() const { return elements_; }

 private:
  PictureFrame frame_;
  double tolerance_m_;
  std::string elements_;
};

}  // namespace roadbed::map::drawing
