#include "roadbed/tools/report/svg.h"

#include <fmt/format.h>

#include <cmath>

#include "roadbed/tools/report/escape.h"
#include "roadbed/tools/report/thin_line.h"

namespace roadbed::tools::inline report {
namespace {

constexpr double kTolerance_px = 0.2;

std::string path_data(const PictureFrame& frame, std::span<const Eigen::Vector2d> points_in_source,
                      bool closed) {
  LineInSource line_px;
  for (const auto& point : points_in_source) line_px.push_back(frame.to_px(point));
  std::string data;
  for (const auto& point : thin_line(line_px, kTolerance_px)) {
    data += data.empty() ? 'M' : 'L';
    data += svg_number(point.x()) + ' ' + svg_number(point.y());
  }
  return closed && !data.empty() ? data + 'Z' : data;
}

}  // namespace

Eigen::Vector2d PictureFrame::to_px(const Eigen::Vector2d& in_source) const {
  const Eigen::Vector2d offset = px_per_m * (in_source - centre_in_source);
  return centre_px + Eigen::Vector2d(offset.x(), -offset.y());
}

std::string svg_number(double value_px) {
  const double rounded = std::round(10.0 * value_px) / 10.0;
  return fmt::format("{}", rounded == 0.0 ? 0.0 : rounded);  // no minus zero
}

std::string svg_line(const PictureFrame& frame, std::span<const Eigen::Vector2d> points_in_source) {
  return path_data(frame, points_in_source, false);
}

std::string svg_ring(const PictureFrame& frame, std::span<const Eigen::Vector2d> points_in_source) {
  return path_data(frame, points_in_source, true);
}

std::string svg_box(const PictureFrame& frame, const Eigen::AlignedBox2d& box_in_source) {
  const Eigen::Vector2d upper_left =
      frame.to_px({box_in_source.min().x(), box_in_source.max().y()});
  const Eigen::Vector2d size_px = frame.px_per_m * box_in_source.sizes();
  return fmt::format("M{} {}h{}v{}h-{}z", svg_number(upper_left.x()), svg_number(upper_left.y()),
                     svg_number(size_px.x()), svg_number(size_px.y()), svg_number(size_px.x()));
}

std::string svg_path(std::string_view css_class, std::string_view data) {
  if (data.empty()) return {};
  return fmt::format("<path class=\"{}\" d=\"{}\"/>\n", css_class, data);
}

std::string svg_text(std::string_view css_class, const Eigen::Vector2d& at_px,
                     std::string_view text) {
  return fmt::format("<text class=\"{}\" x=\"{}\" y=\"{}\">{}</text>\n", css_class,
                     svg_number(at_px.x()), svg_number(at_px.y()), escape_markup(text));
}

}  // namespace roadbed::tools
