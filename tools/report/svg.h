#pragma once

#include <Eigen/Geometry>
#include <span>
#include <string>
#include <string_view>

namespace roadbed::tools::inline report {

/// Puts a part of the plane on a picture: x right, y up in the plane, y down in the picture.
struct PictureFrame {
  Eigen::Vector2d centre_in_source{0, 0};
  Eigen::Vector2d centre_px{0, 0};
  double px_per_m = 1.0;

  Eigen::Vector2d to_px(const Eigen::Vector2d& in_source) const;
};

/// "12.3": one decimal, no zeros at the end.
std::string svg_number(double value_px);

/// Path data of an open line, or of a closed ring, in a picture; lines lose the points that are
/// within a fifth of a pixel of what is left.
std::string svg_line(const PictureFrame& frame, std::span<const Eigen::Vector2d> points_in_source);
std::string svg_ring(const PictureFrame& frame, std::span<const Eigen::Vector2d> points_in_source);

/// Path data of a box that is upright in the picture.
std::string svg_box(const PictureFrame& frame, const Eigen::AlignedBox2d& box_in_source);

/// `<path class="…" d="…"/>`, nothing if there is no data.
std::string svg_path(std::string_view css_class, std::string_view data);

/// Text at a place; its letters are escaped.
std::string svg_text(std::string_view css_class, const Eigen::Vector2d& at_px,
                     std::string_view text);

}  // namespace roadbed::tools
