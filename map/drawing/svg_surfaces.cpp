#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "roadbed/map/derived/surface.h"
#include "roadbed/map/drawing/svg_drawing.h"

namespace roadbed::map::inline drawing::svg {
namespace {

using Eigen::Vector2d;

std::string filled(std::string_view colour, double seam_m) {
  return fmt::format(R"(fill="{}" fill-rule="evenodd" stroke="{}" stroke-width="{:.3f}")", colour,
                     colour, seam_m);
}

/// The outermost lines of roads on a bridge, which hide what passes below.
void draw_parapets(Drawing& drawing, const std::vector<LaneId>& lanes) {
  std::string data;
  for (const LaneId id : lanes) {
    const Lane& lane = drawing.road_map.lane(id);
    const LaneLinks& links = drawing.road_map.graph().of(id);
    if (!links.left) data += drawing.canvas.line(lane.left.in_map.points());
    if (!links.right) data += drawing.canvas.line(lane.right.in_map.points());
  }
  drawing.canvas.add_path(data, stroke(kKerb, drawing.sheet.stroke_m(0.5, 1.1)));
}

}  // namespace

std::string_view ground_colour(LaneType type) {
  switch (type) {
    case LaneType::sidewalk:
      return "#ded8cc";
    case LaneType::shoulder:
    case LaneType::border:
      return "#c6c2b8";
    case LaneType::curb:
      return "#b3aea3";
    case LaneType::parking:
    case LaneType::stop:
      return "#8a94a3";
    case LaneType::biking:
      return "#c9897b";
    case LaneType::median:
    case LaneType::none:
      return type == LaneType::median ? "#c3d3ab" : "#dfe3cf";
    case LaneType::bus:
    case LaneType::taxi:
      return "#6d5560";
    case LaneType::tram:
    case LaneType::rail:
      return "#a39a8c";
    case LaneType::restricted:
    case LaneType::roadworks:
    case LaneType::other:
      return "#d2c2b1";
    default:
      return {};
  }
}

std::string stroke(std::string_view colour, double width_m, std::string_view more) {
  return fmt::format(R"(fill="none" stroke="{}" stroke-width="{:.3f}"{}{})", colour, width_m,
                     more.empty() ? "" : " ", more);
}

void draw_grid(Drawing& drawing) {
  const Sheet& sheet = drawing.sheet;
  const double step_m = std::pow(10.0, std::ceil(std::log10(sheet.longer_m / 12.0)));
  const Vector2d low =
      drawing.road_map.to_source(sheet.upper_left_in_map - Vector2d(0.0, sheet.size_m.y()));
  const Vector2d high = low + sheet.size_m;
  std::string data;
  for (double x = std::ceil(low.x() / step_m) * step_m; x < high.x(); x += step_m) {
    data += fmt::format("M{:.2f} 0v{:.2f}", x - low.x(), sheet.size_m.y());
  }
  for (double y = std::ceil(low.y() / step_m) * step_m; y < high.y(); y += step_m) {
    data += fmt::format("M0 {:.2f}h{:.2f}", high.y() - y, sheet.size_m.x());
  }
  drawing.canvas.add_path(data, stroke("#e9e5dc", sheet.px_m));
}

// Road areas look like carriageway, with the line in their middle; others like pavement.
void draw_areas(Drawing& drawing) {
  std::string others;
  for (const Area& area : drawing.road_map.areas()) {
    if (!area.is_road) others += drawing.canvas.region(area.in_map);
  }
  drawing.canvas.add_path(others, R"(fill="#ded8cc" fill-rule="evenodd")");
  drawing.canvas.add_path(drawing.canvas.region(road_area_surface(drawing.road_map)),
                          std::string(R"(fill=")") + kAsphalt + R"(" fill-rule="evenodd")");
  std::string middle;
  for (const geometry::MedialBranch& branch : road_centrelines(drawing.road_map)) {
    middle += drawing.canvas.line(branch.line.points());
  }
  drawing.canvas.add_path(middle, stroke(kPath, drawing.sheet.stroke_m(0.1, 0.6)));
}

void draw_surfaces(Drawing& drawing, const std::vector<LaneId>& lanes, bool is_bridge) {
  const double seam_m = drawing.sheet.stroke_m(0.02, 0.3);
  if (is_bridge) draw_parapets(drawing, lanes);
  std::map<LaneType, std::string> ground;
  std::vector<LaneId> drivable;
  std::map<JunctionId, std::vector<LaneId>> in_junctions;
  for (const LaneId id : lanes) {
    const Lane& lane = drawing.road_map.lane(id);
    if (!ground_colour(lane.type).empty()) ground[lane.type] += drawing.canvas.ring(lane.polygon);
    if (!is_drivable(lane.type)) continue;
    drivable.push_back(id);
    if (lane.junction) in_junctions[*lane.junction].push_back(id);
  }
  for (const auto& [type, path] : ground) {
    drawing.canvas.add_path(path, filled(ground_colour(type), seam_m));
    auto& known = drawing.shown.ground;
    if (std::find(known.begin(), known.end(), type) == known.end()) known.push_back(type);
  }
  const auto region = [&](const std::vector<LaneId>& of) {
    return drawing.canvas.region(lanes_surface(drawing.road_map, of).polygons);
  };
  drawing.canvas.add_path(region(drivable), filled(kAsphalt, seam_m));
  std::string junctions;
  for (const auto& [id, of] : in_junctions) junctions += region(of);
  drawing.canvas.add_path(junctions, fmt::format(R"(fill="{}" fill-rule="evenodd")", kJunction));
  drawing.shown.junctions = drawing.shown.junctions || !junctions.empty();
}

}  // namespace roadbed::map::drawing::svg
