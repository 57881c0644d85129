#include "roadbed/map/drawing/svg_canvas.h"

#include <fmt/format.h>

#include <iterator>
#include <vector>

#include "roadbed/geometry/primitives/simplify.h"

namespace roadbed::map::inline drawing {

Eigen::Vector2d SvgCanvas::to_picture(const Eigen::Vector2d& in_map) const {
  return {in_map.x() - upper_left_in_map_.x(), upper_left_in_map_.y() - in_map.y()};
}

std::string SvgCanvas::line(std::span<const Eigen::Vector2d> points_in_map) const {
  std::string data;
  char command = 'M';
  for (const Eigen::Vector2d& point : geometry::simplify(points_in_map, tolerance_m_)) {
    const Eigen::Vector2d at = to_picture(point);
    fmt::format_to(std::back_inserter(data), "{}{:.2f} {:.2f}", command, at.x(), at.y());
    command = 'L';
  }
  return data;
}

std::string SvgCanvas::ring(const geometry::Ring& ring_in_map) const {
  if (ring_in_map.size() < 3) return {};
  std::vector<Eigen::Vector2d> closed = ring_in_map;
  closed.push_back(ring_in_map.front());
  return line(closed) + "Z";
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
  if (data.empty()) return;
  fmt::format_to(std::back_inserter(elements_), "<path {} d=\"{}\"/>\n", attributes, data);
}

void SvgCanvas::add(std::string_view element) {
  elements_ += element;
  elements_ += '\n';
}

}  // namespace roadbed::map::drawing
