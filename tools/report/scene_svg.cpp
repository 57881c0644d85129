#include "roadbed/tools/report/report.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "roadbed/map/drawing/svg.h"
#include "roadbed/map/files/xml_characters.h"
#include "roadbed/tools/report/surroundings.h"
#include "roadbed/tools/report/svg_legend.h"

namespace roadbed::tools::inline report {
namespace {

using Eigen::Vector2d;
using Box = Eigen::AlignedBox2d;

constexpr double kSceneWidth_px = 900.0, kSceneLegend_px = 46.0, kSceneMargin_px = 56.0;
constexpr double kLeastSceneHeight_px = 300.0, kMostSceneHeight_px = 620.0;
constexpr double kMostSceneScale_px_per_m = 14.0;

constexpr std::string_view kStyle = R"(<style>
.ground{fill:#eceee8}.strip{fill:#fff}.drive{fill:#c3c8d0;stroke:#c3c8d0;stroke-width:.6}
.junction{fill:#b9bfc9;stroke:#b9bfc9;stroke-width:.6}.shoulder{fill:#d3d6d9}.walk{fill:#dfd9cc}
.bike{fill:#cfd9c8}.other{fill:#dcdfda}.border{fill:none;stroke:#fff}
.route{fill:none;stroke:#56b4e9;stroke-opacity:.45;stroke-linecap:round;stroke-linejoin:round}
.occupied{fill:#4b3f33;stroke:#4b3f33;stroke-width:.8}.casing{fill:none;stroke:#10141a;stroke-width:5.4;stroke-linejoin:round;stroke-linecap:round}
.speed{fill:none;stroke-width:3.6;stroke-linejoin:round}.ego{fill:#2f9be0;stroke:#10141a;stroke-width:.8}
.moving{fill:#d55e00;stroke:#10141a;stroke-width:.8}.standing{fill:#e69f00;stroke:#10141a;stroke-width:.8}
.motion{fill:none;stroke:#d55e00;stroke-width:1.3;stroke-dasharray:4 3}
.pin{stroke:#fff;stroke-width:1.5}.start{fill:#0072b2}.goal{fill:#00785a}.line{fill:none;stroke:#1b2029;stroke-width:1.4}
text{font:12px system-ui,-apple-system,"Segoe UI","DejaVu Sans",sans-serif;fill:#1b2029}
.over{paint-order:stroke;stroke:#fff;stroke-opacity:.85;stroke-width:3px;stroke-linejoin:round}.time{font-size:11px}
.mid{text-anchor:middle}
</style>
)";

void extend(Box& box, std::span<const Vector2d> points) {
  for (const Vector2d& point : points) box.extend(point);
}

Box shown_box(const ReportInput& input) {
  Box box;
  for (const auto& point : input.drive.trajectory.points()) box.extend(point.pose().position());
  if (input.scene.goal) box.extend(*input.scene.goal);
  if (input.drive.trajectory.empty()) {
    for (const LineInSource& leg : input.scene.route) extend(box, leg);
  }
  if (box.isEmpty() && input.scene.road_map) {
    for (const map::Lane& lane : input.scene.road_map->lanes()) {
      extend(box, line_in_source(*input.scene.road_map, lane.centre.in_map));
    }
  }
  return box.isEmpty() ? Box(Vector2d(-10, -10), Vector2d(10, 10)) : box;
}

map::PictureFrame lay_out(const Box& box) {
  const Vector2d size = box.sizes().cwiseMax(1.0);
  const double wide_px = kSceneWidth_px - 2.0 * kSceneMargin_px;
  double scale = std::min(wide_px / size.x(), kMostSceneScale_px_per_m);
  const double height_px = std::clamp(scale * size.y() + 2.0 * kSceneMargin_px,
                                      kLeastSceneHeight_px, kMostSceneHeight_px);
  scale = std::min(scale, (height_px - 2.0 * kSceneMargin_px) / size.y());
  return {.centre_in_plane = box.center(),
          .centre_px = {0.5 * kSceneWidth_px, 0.5 * height_px},
          .px_per_m = scale,
          .size_px = {kSceneWidth_px, height_px}};
}

// Which of a few colours a lane has; empty: it is not drawn.
std::string_view look_of(const map::Lane& lane) {
  using map::LaneType;
  const bool in_junction = lane.junction.has_value();
  if (map::is_drivable(lane.type)) return in_junction ? "junction" : "drive";
  switch (lane.type) {
    case LaneType::none:
      return {};
    case LaneType::bus:
    case LaneType::taxi:
      return in_junction ? "junction" : "drive";
    case LaneType::shoulder:
    case LaneType::stop:
    case LaneType::parking:
    case LaneType::border:
      return "shoulder";
    case LaneType::sidewalk:
    case LaneType::curb:
    case LaneType::median:
      return "walk";
    case LaneType::biking:
      return "bike";
    default:
      return "other";
  }
}

std::string lanes_svg(const ReportInput& input, const map::PictureFrame& frame) {
  // Drawn in this order, so that junctions lie on top of what they join.
  constexpr std::array<std::string_view, 6> kKinds = {"other",    "walk",  "bike",
                                                      "shoulder", "drive", "junction"};
  std::map<std::string_view, std::string> areas;
  std::string borders;
  if (!input.scene.road_map) return {};
  const map::RoadMap& road_map = *input.scene.road_map;
  for (const map::Lane& lane : road_map.lanes()) {
    const std::string_view look = look_of(lane);
    const LineInSource outline = outline_in_source(road_map, lane);
    Box box;
    extend(box, outline);
    if (look.empty() || !frame.shows(box)) continue;
    areas[look] += map::svg_ring(frame, outline);
    if (lane.junction) continue;
    for (const map::LaneLine* border : {&lane.left, &lane.right}) {
      borders += map::svg_line(frame, line_in_source(road_map, border->in_map));
    }
  }
  std::string svg;
  for (const std::string_view look : kKinds) svg += map::svg_path(look, areas[look]);
  // Far away, borders are thinner than a pixel, or they would hide their lanes.
  return svg + map::svg_styled_path(fmt::format("class=\"border\" stroke-width=\"{:.2f}\"",
                                                std::min(0.9, 0.3 * frame.px_per_m)),
                                    borders);
}

std::string route_svg(const ReportInput& input, const map::PictureFrame& frame) {
  std::string data;
  for (const LineInSource& leg : input.scene.route) data += map::svg_line(frame, leg);
  return map::svg_styled_path(fmt::format("class=\"route\" stroke-width=\"{}\"",
                                          map::svg_number(std::max(6.0, 2.4 * frame.px_per_m))),
                              data);
}

std::string occupied_svg(const ReportInput& input, const map::PictureFrame& frame) {
  std::string data;
  for (const map::Box2& box : input.scene.occupied) {
    const Box shown(box.min_in_source, box.max_in_source);
    if (frame.shows(shown)) data += map::svg_box(frame, shown);
  }
  return map::svg_path("occupied", data);
}

double top_speed_mps(const geometry::Trajectory& drive) {
  double top_mps = 0.0;
  for (const auto& point : drive.points()) top_mps = std::max(top_mps, point.speed_mps);
  return std::max(1.0, top_mps);
}

// The driven path in pieces of one colour each, on a dark casing.
std::string driven_svg(const ReportInput& input, const map::PictureFrame& frame) {
  constexpr int kShades = 24;
  const auto& points = input.drive.trajectory.points();
  const double top_mps = top_speed_mps(input.drive.trajectory);
  LineInSource whole;
  for (const auto& point : points) whole.push_back(point.pose().position());
  std::string svg = map::svg_path("casing", map::svg_line(frame, whole));
  const auto shade = [&](std::size_t i) {
    return static_cast<int>(std::round(kShades * points[i].speed_mps / top_mps));
  };
  for (std::size_t from = 0; from + 1 < points.size();) {
    std::size_t to = from + 1;
    while (to + 1 < points.size() && shade(to) == shade(from)) ++to;
    const std::span<const Vector2d> piece(whole.begin() + static_cast<std::ptrdiff_t>(from),
                                          to - from + 1);
    const std::string colour = speed_colour(static_cast<double>(shade(from)) / kShades);
    svg += map::svg_styled_path(fmt::format("class=\"speed\" stroke=\"{}\"", colour),
                                map::svg_line(frame, piece));
    from = to;
  }
  return svg;
}

LineInSource body_at(const geometry::Pose2& source_from_body, double back_m, double front_m,
                     double width_m) {
  const double half_m = 0.5 * width_m;
  return {
      source_from_body * Vector2d(back_m, -half_m), source_from_body * Vector2d(front_m, -half_m),
      source_from_body * Vector2d(front_m, half_m), source_from_body * Vector2d(back_m, half_m)};
}

// Every few seconds, at most fourteen times.
std::vector<double> footprint_times(const geometry::Trajectory& drive) {
  if (drive.empty()) return {};
  const double duration_s = drive.end_s() - drive.start_s();
  double step_s = 1.0;
  for (const double longer_s : {2.0, 5.0, 10.0, 20.0, 60.0, 300.0}) {
    if (duration_s / step_s > 14.0) step_s = longer_s;
  }
  std::vector<double> times;
  for (int i = 0; i * step_s <= duration_s; ++i) times.push_back(drive.start_s() + i * step_s);
  return times;
}

Vector2d left_of(const geometry::Pose2& pose, double distance_px) {
  return {-distance_px * std::sin(pose.heading_rad), -distance_px * std::cos(pose.heading_rad)};
}

std::string vehicle_svg(const ReportInput& input, const map::PictureFrame& frame) {
  const geometry::VehicleShape& shape = input.scene.vehicle;
  std::string bodies, labels;
  for (const double t_s : footprint_times(input.drive.trajectory)) {
    const geometry::Pose2 pose = input.drive.trajectory.at(t_s).pose();
    bodies +=
        map::svg_ring(frame, body_at(pose, -shape.rear_overhang_m, shape.front_m(), shape.width_m));
    if (t_s == input.drive.trajectory.start_s()) continue;  // the pin is there
    const Vector2d at_px = frame.to_px(pose.position()) + left_of(pose, 16.0);
    labels += map::svg_text("over time mid", at_px + Vector2d(0, 4), fmt::format("{:.0f} s", t_s));
  }
  return map::svg_path("ego", bodies) + labels;
}

LineInSource motion_within(const planning::ObstacleInSource& obstacle, double from_s, double to_s) {
  LineInSource line{obstacle.motion.at(from_s).pose().position()};
  for (const auto& point : obstacle.motion.points()) {
    if (point.t_s > from_s && point.t_s < to_s) line.push_back(point.pose().position());
  }
  line.push_back(obstacle.motion.at(to_s).pose().position());
  return line;
}

LineInSource obstacle_at(const planning::ObstacleInSource& obstacle, double t_s) {
  return body_at(obstacle.motion.at(t_s).pose(), -0.5 * obstacle.length_m, 0.5 * obstacle.length_m,
                 obstacle.width_m);
}

// When the obstacle moves during the drive; empty (to before from) if it does not.
struct Span {
  double from_s = 0.0, to_s = -1.0;
};

Span moving_span(const planning::ObstacleInSource& obstacle, const geometry::Trajectory& drive) {
  if (drive.empty() || obstacle.motion.empty() || obstacle.is_static()) return {};
  return {std::max(drive.start_s(), obstacle.motion.start_s()),
          std::min(drive.end_s(), obstacle.motion.end_s())};
}

std::string motions_svg(const ReportInput& input, const map::PictureFrame& frame) {
  std::string data;
  for (const planning::ObstacleInSource& obstacle : input.scene.obstacles) {
    const Span span = moving_span(obstacle, input.drive.trajectory);
    if (span.to_s <= span.from_s) continue;
    data += map::svg_line(frame, motion_within(obstacle, span.from_s, span.to_s));
  }
  return map::svg_path("motion", data);
}

// Bodies at the times of the vehicle's footprints.
std::string obstacles_svg(const ReportInput& input, const map::PictureFrame& frame) {
  std::string moving, standing;
  for (const planning::ObstacleInSource& obstacle : input.scene.obstacles) {
    if (obstacle.motion.empty()) continue;
    if (obstacle.is_static()) standing += map::svg_ring(frame, obstacle_at(obstacle, 0.0));
    const Span span = moving_span(obstacle, input.drive.trajectory);
    for (const double t_s : footprint_times(input.drive.trajectory)) {
      if (t_s < span.from_s || t_s > span.to_s) continue;
      moving += map::svg_ring(frame, obstacle_at(obstacle, t_s));
    }
  }
  return map::svg_path("moving", moving) + map::svg_path("standing", standing);
}

std::string pin_svg(std::string_view css_class, const Vector2d& at_px, std::string_view text) {
  return fmt::format("<path class=\"pin {}\" d=\"M{} {}l-5.7-10.4a8 8 0 1 1 11.4 0z\"/>\n",
                     css_class, map::svg_number(at_px.x()), map::svg_number(at_px.y())) +
         map::svg_text("over", at_px + Vector2d(11, -14), text);
}

std::string ends_svg(const ReportInput& input, const map::PictureFrame& frame) {
  std::string svg;
  if (!input.drive.trajectory.empty()) {
    const Vector2d start = input.drive.trajectory.points().front().pose().position();
    svg += pin_svg("start", frame.to_px(start), "start");
  }
  if (input.scene.goal) svg += pin_svg("goal", frame.to_px(*input.scene.goal), "goal");
  return svg;
}

std::string scale_bar_svg(const map::PictureFrame& frame) {
  const double length_m = map::round_length_m(130.0 / frame.px_per_m);
  const double width_px = length_m * frame.px_per_m;
  const double x = kSceneWidth_px - 18.0 - width_px, y = frame.size_px.y() - 16.0;
  return fmt::format("<path class=\"line\" d=\"M{0} {1}v6h{2}v-6\"/>\n", map::svg_number(x),
                     map::svg_number(y - 6.0), map::svg_number(width_px)) +
         map::svg_text("over", {x + 5.0, y - 6.0}, fmt::format("{} m", length_m));
}

std::string legend_svg(const ReportInput& input, const map::PictureFrame& frame) {
  SvgLegend legend(frame.size_px.y() + 0.5 * kSceneLegend_px + 4.0);
  if (!input.drive.trajectory.empty()) {
    legend.add_speeds(top_speed_mps(input.drive.trajectory));
    legend.add("class=\"ego\"", "vehicle");
  }
  if (!input.scene.route.empty()) legend.add("fill=\"#a5d0ea\"", "route");
  const auto moving =
      std::ranges::count_if(input.scene.obstacles,
                            [](const planning::ObstacleInSource& one) { return !one.is_static(); });
  if (moving > 0) legend.add("class=\"moving\"", "moving");
  if (moving < std::ssize(input.scene.obstacles)) legend.add("class=\"standing\"", "standing");
  if (!input.scene.occupied.empty()) legend.add("class=\"occupied\"", "occupied");
  return fmt::format("<rect class=\"strip\" y=\"{}\" width=\"{}\" height=\"{}\"/>\n",
                     map::svg_number(frame.size_px.y()), map::svg_number(kSceneWidth_px),
                     map::svg_number(kSceneLegend_px)) +
         legend.svg();
}

}  // namespace

std::string drive_scene_svg(const ReportInput& input) {
  const map::PictureFrame frame = lay_out(shown_box(input));
  const std::string size =
      fmt::format("width=\"{}\" height=\"{}\"", map::svg_number(kSceneWidth_px),
                  map::svg_number(frame.size_px.y() + kSceneLegend_px));
  std::string svg = fmt::format(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" {0} viewBox=\"0 0 {1} {2}\" role=\"img\">\n"
      "<title>{3}</title>\n{4}"
      "<clipPath id=\"card\"><rect {0} rx=\"10\"/></clipPath><g clip-path=\"url(#card)\">\n"
      "<clipPath id=\"map\"><rect width=\"{1}\" height=\"{5}\"/></clipPath>"
      "<g clip-path=\"url(#map)\"><rect class=\"ground\" width=\"{1}\" height=\"{5}\"/>\n",
      size, map::svg_number(kSceneWidth_px), map::svg_number(frame.size_px.y() + kSceneLegend_px),
      map::html_text(input.title), kStyle, map::svg_number(frame.size_px.y()));
  svg += lanes_svg(input, frame) + route_svg(input, frame) + occupied_svg(input, frame);
  svg += motions_svg(input, frame) + driven_svg(input, frame);
  svg += obstacles_svg(input, frame) + vehicle_svg(input, frame);
  svg += ends_svg(input, frame) + scale_bar_svg(frame) + "</g>\n";
  return svg + legend_svg(input, frame) + "</g></svg>\n";
}

}  // namespace roadbed::tools::report
