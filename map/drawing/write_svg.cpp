#include "roadbed/map/drawing/write_svg.h"

#include <fmt/format.h>

#include <algorithm>

#include "roadbed/map/derived/conflicts.h"
#include "roadbed/map/drawing/svg_drawing.h"
#include "roadbed/map/files/xml_characters.h"

namespace roadbed::map::inline drawing {

namespace svg {

using Eigen::Vector2d;

Sheet::Sheet(const RoadMap& road_map, double longer_side_px) {
  bool is_first = true;
  const auto add = [&](const std::vector<Vector2d>& points) {
    for (const Vector2d& point : points) {
      low_in_map = is_first ? point : low_in_map.cwiseMin(point).eval();
      high_in_map = is_first ? point : high_in_map.cwiseMax(point).eval();
      is_first = false;
    }
  };
  for (const Lane& lane : road_map.lanes()) {
    add(lane.left.in_map.points());
    add(lane.right.in_map.points());
  }
  for (const Area& area : road_map.areas()) {
    for (const geometry::Polygon& polygon : area.in_map) add(polygon.outer);
  }
  const Vector2d extent = high_in_map - low_in_map;
  longer_m = std::max(extent.maxCoeff(), 1.0) * 1.06;
  px_m = longer_m / longer_side_px;
  const double margin_m = 0.03 * longer_m;
  const double least_m = 0.6 * longer_m;  // room for the caption below narrow maps
  const double width_m = std::max(extent.x() + 2.0 * margin_m, least_m);
  const double middle_m = 0.5 * (low_in_map.x() + high_in_map.x());
  upper_left_in_map = {middle_m - 0.5 * width_m, high_in_map.y() + margin_m};
  size_m = {width_m, extent.y() + 2.0 * margin_m};
  caption_m = 92.0 * px_m;
}

double Sheet::stroke_m(double least_m, double least_px) const {
  return std::max(least_m, least_px * px_m);
}

namespace {

/// Lanes by level, in order of id.
std::vector<std::vector<LaneId>> lanes_of_levels(const RoadMap& road_map) {
  const std::vector<int> levels = levels_of_lanes(road_map);
  std::vector<std::vector<LaneId>> lanes(1);
  for (const Lane& lane : road_map.lanes()) {
    const auto level = static_cast<std::size_t>(levels[lane.id.index]);
    if (level >= lanes.size()) lanes.resize(level + 1);
    lanes[level].push_back(lane.id);
  }
  return lanes;
}

void draw_mark(Drawing& drawing, const SvgMark& mark) {
  const Vector2d place = drawing.canvas.to_picture(mark.in_map);
  const double px = drawing.sheet.px_m;
  drawing.canvas.add(fmt::format(
      R"(<circle cx="{:.2f}" cy="{:.2f}" r="{:.2f}" fill="{}" fill-opacity="0.35" stroke="{}" )"
      R"(stroke-width="{:.3f}"><title>{}</title></circle>)",
      place.x(), place.y(), 6.0 * px, mark.colour, mark.colour, 1.5 * px, html_text(mark.title)));
}

std::string document(const Drawing& drawing) {
  const Sheet& sheet = drawing.sheet;
  const Vector2d size_m(sheet.size_m.x(), sheet.size_m.y() + sheet.caption_m);
  const Vector2d corner = drawing.road_map.to_source(sheet.upper_left_in_map);
  return fmt::format(R"(<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {:.3f} {:.3f}" )"
                     R"(font-family="Helvetica, Arial, sans-serif" fill="{}" )"
                     R"(stroke-linejoin="round" style="background:{}">)",
                     size_m.x(), size_m.y(), kInk, kPaper) +
         fmt::format("\n<desc>metres; source x = {} + x, source y = {} - y</desc>\n", corner.x(),
                     corner.y()) +
         fmt::format("<rect width=\"{:.3f}\" height=\"{:.3f}\" fill=\"{}\"/>\n", size_m.x(),
                     size_m.y(), kPaper) +
         drawing.canvas.elements() + "</svg>\n";
}

}  // namespace
}  // namespace svg

std::string write_svg(const RoadMap& road_map, const SvgOptions& options) {
  const svg::Sheet sheet(road_map, options.longer_side_px);
  svg::Drawing drawing{road_map, sheet, SvgCanvas(sheet.upper_left_in_map, 0.05 * sheet.px_m), {}};
  draw_grid(drawing);
  draw_areas(drawing);
  draw_objects(drawing);
  bool is_bridge = false;
  for (const std::vector<LaneId>& lanes : svg::lanes_of_levels(road_map)) {
    draw_surfaces(drawing, lanes, is_bridge);
    draw_directions(drawing, lanes);
    draw_markings(drawing, lanes);
    is_bridge = true;
  }
  draw_painted_objects(drawing);
  draw_stop_lines(drawing);
  draw_names(drawing);
  draw_signals(drawing);
  draw_caption(drawing);
  for (const SvgMark& mark : options.marks) svg::draw_mark(drawing, mark);
  return svg::document(drawing);
}

}  // namespace roadbed::map::drawing
