#include <fmt/format.h>

#include <array>

#include "roadbed/map/drawing/svg_drawing.h"
#include "roadbed/map/files/xml_characters.h"

namespace roadbed::map::inline drawing::svg {
namespace {

using Eigen::Vector2d;

/// The two middles of a crosswalk's shorter sides, and how wide it is: for an outline of four
/// corners; others are drawn as areas.
struct Zebra {
  Vector2d from, to;
  double width_m;
};

Zebra zebra_of(const geometry::Ring& corners) {
  const auto middle = [&](std::size_t i) { return 0.5 * (corners[i] + corners[(i + 1) % 4]); };
  const auto side = [&](std::size_t i) { return (corners[(i + 1) % 4] - corners[i]).norm(); };
  const std::size_t shorter = side(0) + side(2) < side(1) + side(3) ? 0 : 1;
  return {middle(shorter), middle(shorter + 2), 0.5 * (side(shorter) + side(shorter + 2))};
}

void draw_crosswalk(Drawing& drawing, const geometry::Ring& outline) {
  geometry::Ring corners = outline;
  if (corners.size() == 5 && (corners.front() - corners.back()).norm() < 1e-6) corners.pop_back();
  if (corners.size() != 4) {
    drawing.canvas.add_path(drawing.canvas.ring(corners),
                            fmt::format(R"(fill="{}" fill-opacity="0.75")", kWhite));
    return;
  }
  const Zebra zebra = zebra_of(corners);
  const double bar_m = drawing.sheet.stroke_m(0.5, 0.7);
  drawing.canvas.add_path(
      drawing.canvas.line(std::array{zebra.from, zebra.to}),
      stroke(kWhite, zebra.width_m, fmt::format(R"(stroke-dasharray="{:.3f}")", bar_m)));
}

std::string_view object_colour(const std::string& type) {
  if (type == "building") return "#cfc6b8";
  if (type == "parkingSpace") return "#8a94a3";
  if (type == "trafficIsland") return "#c3d3ab";
  if (type == "vegetation" || type == "tree") return "#b7cc9f";
  return "#c9b79a";
}

/// Whether the object is on the road's surface; others may hide it, as a bridge does.
bool is_painted(const MapObject& object) {
  return object.type == "crosswalk" || object.type == "parkingSpace";
}

void draw_outline(Drawing& drawing, const MapObject& object) {
  drawing.canvas.add_path(
      drawing.canvas.ring(object.outline_in_map),
      fmt::format(R"(fill="{}" fill-opacity="0.8" stroke="{}" stroke-width="{:.3f}")",
                  object_colour(object.type), kFaint, drawing.sheet.stroke_m(0.05, 0.25)));
}

/// A light as a dark box with three lamps, a sign as a disc.
std::string signal_symbol(const Drawing& drawing, const Signal& signal) {
  const Vector2d at = drawing.canvas.to_picture(signal.in_map);
  const double r = drawing.sheet.stroke_m(0.4, 1.15);
  const std::string title = html_text(signal.source_id + " " + signal.name);
  if (!signal.dynamic) {
    return fmt::format(
        R"(<circle cx="{:.2f}" cy="{:.2f}" r="{:.2f}" fill="#ffffff" stroke="#c8372d" )"
        R"(stroke-width="{:.2f}"><title>{}</title></circle>)",
        at.x(), at.y(), 1.3 * r, 0.5 * r, title);
  }
  std::string lamps;
  constexpr std::array<const char*, 3> kLamps = {"#e5483d", "#f3c14b", "#55c26a"};
  for (int i = 0; i < 3; ++i) {
    lamps += fmt::format(R"(<circle cx="{:.2f}" cy="{:.2f}" r="{:.2f}" fill="{}"/>)", at.x(),
                         at.y() + (i - 1) * 1.9 * r, 0.75 * r, kLamps[static_cast<std::size_t>(i)]);
  }
  return fmt::format(
      R"(<g><title>{}</title><rect x="{:.2f}" y="{:.2f}" width="{:.2f}" height="{:.2f}" )"
      R"(rx="{:.2f}" fill="{}" stroke="#ffffff" stroke-width="{:.2f}"/>{}</g>)",
      title, at.x() - 1.2 * r, at.y() - 3.1 * r, 2.4 * r, 6.2 * r, 0.9 * r, kInk, 0.25 * r, lamps);
}

}  // namespace

void draw_objects(Drawing& drawing) {
  for (const MapObject& object : drawing.road_map.objects()) {
    if (object.outline_in_map.size() < 3 || is_painted(object)) continue;
    draw_outline(drawing, object);
  }
}

void draw_painted_objects(Drawing& drawing) {
  for (const MapObject& object : drawing.road_map.objects()) {
    if (object.outline_in_map.size() < 3 || !is_painted(object)) continue;
    if (object.type != "crosswalk") {
      draw_outline(drawing, object);
      continue;
    }
    draw_crosswalk(drawing, object.outline_in_map);
    drawing.shown.crosswalks = true;
  }
}

void draw_stop_lines(Drawing& drawing) {
  std::string data;
  for (const StopLine& stop_line : drawing.road_map.stop_lines()) {
    std::vector<Vector2d> points;
    for (const Eigen::Vector3d& point : stop_line.in_map) points.emplace_back(point.head<2>());
    if (points.size() > 1) data += drawing.canvas.line(points);
  }
  drawing.shown.stop_lines = !data.empty();
  drawing.canvas.add_path(data, stroke(kStop, drawing.sheet.stroke_m(0.4, 0.9)));
}

void draw_signals(Drawing& drawing) {
  for (const Signal& signal : drawing.road_map.signals()) {
    drawing.canvas.add(signal_symbol(drawing, signal));
    (signal.dynamic ? drawing.shown.lights : drawing.shown.signs) = true;
  }
}

/// Areas that show nothing but a lane's name where the pointer is.
void draw_names(Drawing& drawing) {
  drawing.canvas.add(R"(<g fill="#ffffff" fill-opacity="0">)");
  for (const Lane& lane : drawing.road_map.lanes()) {
    const std::string data = drawing.canvas.ring(lane.polygon);
    if (data.empty()) continue;
    drawing.canvas.add(fmt::format("<path d=\"{}\"><title>{} · {} · {:.1f} m</title></path>", data,
                                   html_text(lane.name), to_string(lane.type), lane.length_m()));
  }
  drawing.canvas.add("</g>");
}

}  // namespace roadbed::map::drawing::svg
