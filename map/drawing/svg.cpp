#include "roadbed/map/drawing/svg.h"

#include <fmt/format.h>

#include <cmath>
#include <vector>

#include "roadbed/geometry/primitives/polyline.h"
#include "roadbed/map/files/xml_characters.h"

namespace roadbed::map::inline drawing {
namespace {

using Eigen::Vector2d;

std::string two_decimals(double value) { return fmt::format("{:.2f}", value); }

std::string path_data(const PictureFrame& frame, std::span<const Vector2d> points_px) {
  std::string data;
  for (const Vector2d& point : points_px) {
    data += data.empty() ? 'M' : 'L';
    data += frame.number(point.x()) + ' ' + frame.number(point.y());
  }
  return data;
}

std::vector<Vector2d> in_picture(const PictureFrame& frame, std::span<const Vector2d> in_plane) {
  std::vector<Vector2d> points_px;
  points_px.reserve(in_plane.size());
  for (const Vector2d& point : in_plane) points_px.push_back(frame.to_px(point));
  return points_px;
}

}  // namespace

std::string svg_number(double value_px) {
  const double rounded = std::round(10.0 * value_px) / 10.0;
  return fmt::format("{}", rounded == 0.0 ? 0.0 : rounded);  // no minus zero
}

Vector2d PictureFrame::to_px(const Vector2d& in_plane) const {
  const Vector2d offset = px_per_m * (in_plane - centre_in_plane);
  return centre_px + Vector2d(offset.x(), -offset.y());
}

bool PictureFrame::shows(const Eigen::AlignedBox2d& box_in_plane) const {
  if (box_in_plane.isEmpty()) return false;
  const Vector2d upper_left = to_px({box_in_plane.min().x(), box_in_plane.max().y()});
  return Eigen::AlignedBox2d(upper_left, upper_left + px_per_m * box_in_plane.sizes())
      .intersects(Eigen::AlignedBox2d(Vector2d(0.0, 0.0), size_px));
}

std::string svg_line(const PictureFrame& frame, std::span<const Vector2d> points_in_plane) {
  constexpr double kTolerance_px = 0.2;
  return path_data(frame, geometry::simplify(in_picture(frame, points_in_plane), kTolerance_px));
}

std::string svg_ring(const PictureFrame& frame, std::span<const Vector2d> points_in_plane) {
  const std::string data = svg_line(frame, points_in_plane);
  return data.empty() ? data : data + 'Z';
}

std::string svg_box(const PictureFrame& frame, const Eigen::AlignedBox2d& box_in_plane) {
  const Vector2d upper_left = frame.to_px({box_in_plane.min().x(), box_in_plane.max().y()});
  const Vector2d size_px = frame.px_per_m * box_in_plane.sizes();
  return fmt::format("M{} {}h{}v{}h-{}z", frame.number(upper_left.x()),
                     frame.number(upper_left.y()), frame.number(size_px.x()),
                     frame.number(size_px.y()), frame.number(size_px.x()));
}

std::string svg_styled_path(std::string_view attributes, std::string_view data) {
  if (data.empty()) return {};
  return fmt::format("<path {} d=\"{}\"/>\n", attributes, data);
}

std::string svg_path(std::string_view css_class, std::string_view data) {
  return svg_styled_path(fmt::format("class=\"{}\"", css_class), data);
}

std::string svg_text(std::string_view css_class, const Vector2d& at_px, std::string_view text) {
  return fmt::format("<text class=\"{}\" x=\"{}\" y=\"{}\">{}</text>\n", css_class,
                     svg_number(at_px.x()), svg_number(at_px.y()), html_text(text));
}

double usual_width_px(std::string_view text, double font_px) {
  double width = 0.0;  // in sizes of the font
  for (const char letter : text) {
    if ((static_cast<unsigned char>(letter) & 0xC0U) == 0x80U)
      continue;  // goes with the one before
    const bool is_narrow =
        std::string_view("fijlrt .,:;'!|()[]I").find(letter) != std::string_view::npos;
    const bool is_wide = std::string_view("mwMW%@").find(letter) != std::string_view::npos;
    const bool is_capital = letter >= 'A' && letter <= 'Z';
    width += is_narrow ? 0.33 : is_wide ? 0.87 : is_capital ? 0.68 : 0.58;
  }
  return width * font_px;
}

std::string svg_text_of_width(std::string_view css_class, const Vector2d& at_px,
                              std::string_view text, double width_px) {
  return fmt::format(
      "<text class=\"{}\" x=\"{}\" y=\"{}\" textLength=\"{}\" "
      "lengthAdjust=\"spacingAndGlyphs\">{}</text>\n",
      css_class, svg_number(at_px.x()), svg_number(at_px.y()), svg_number(width_px),
      html_text(text));
}

double round_length_m(double longest_m) {
  const double power = std::pow(10.0, std::floor(std::log10(longest_m)));
  for (const double digit : {5.0, 2.0}) {
    if (digit * power <= longest_m) return digit * power;
  }
  return power;
}

SvgCanvas::SvgCanvas(const Vector2d& upper_left_in_map, double tolerance_m)
    : frame_{.centre_in_plane = upper_left_in_map, .number = two_decimals},
      tolerance_m_(tolerance_m) {}

std::string SvgCanvas::line(std::span<const Vector2d> points_in_map) const {
  // In the map's frame, so that moving the picture never changes which points stay.
  return path_data(frame_, in_picture(frame_, geometry::simplify(points_in_map, tolerance_m_)));
}

// The first point is written twice, so that simplifying keeps to the ring's last edge, too.
std::string SvgCanvas::ring(const geometry::Ring& ring_in_map) const {
  if (ring_in_map.size() < 3) return {};
  std::vector<Vector2d> closed = ring_in_map;
  closed.push_back(ring_in_map.front());
  return line(closed) + 'Z';
}

std::string SvgCanvas::region(std::span<const geometry::Polygon> polygons_in_map) const {
  std::string data;
  for (const geometry::Polygon& polygon : polygons_in_map) {
    data += ring(polygon.outer);
    for (const geometry::Ring& hole : polygon.holes) data += ring(hole);
  }
  return data;
}

void SvgCanvas::add_path(std::string_view data, std::string_view attributes) {
  elements_ += svg_styled_path(attributes, data);
}

void SvgCanvas::add(std::string_view element) {
  elements_ += element;
  elements_ += '\n';
}

}  // namespace roadbed::map::drawing
