#include "roadbed/tools/report/scene_svg.h"

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

#include "roadbed/tools/report/escape.h"
#include "roadbed/tools/report/lane_look.h"
#include "roadbed/tools/report/speed_colour.h"
#include "roadbed/tools/report/svg.h"
#include "roadbed/tools/report/svg_legend.h"

namespace roadbed::tools::inline report {
namespace {

using Eigen::Vector2d;
using Box = Eigen::AlignedBox2d;

constexpr double kWidth_px = 900.0, kSceneLegend_px = 46.0, kMargin_px = 56.0;
constexpr double kLeastHeight_px = 300.0, kMostSceneHeight_px = 620.0;
constexpr double kMostScale_px_per_m = 14.0;

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

// The part of the plane that is shown and the size of the map's part of the picture.
struct Layout {
  PictureFrame frame;
  double height_px = 0.0;
};

void extend(Box& box, std::span<const Vector2d> points) {
  for (const Vector2d& point : points) box.extend(point);
}

Box shown_box(const ReportInput& input) {
  Box box;
  for (const auto& point : input.drive.points()) box.extend(point.pose().position());
  if (input.goal) box.extend(*input.goal);
  if (input.drive.empty()) {
    for (const LineInSource& leg : input.route) extend(box, leg);
  }
  if (box.isEmpty()) {
    for (const ReportLane& lane : input.lanes) extend(box, lane.centre);
  }
  return box.isEmpty() ? Box(Vector2d(-10, -10), Vector2d(10, 10)) : box;
}

Layout lay_out(const Box& box) {
  const Vector2d size = box.sizes().cwiseMax(1.0);
  const double wide_px = kWidth_px - 2.0 * kMargin_px;
  double scale = std::min(wide_px / size.x(), kMostScale_px_per_m);
  const double height_px =
      std::clamp(scale * size.y() + 2.0 * kMargin_px, kLeastHeight_px, kMostSceneHeight_px);
  scale = std::min(scale, (height_px - 2.0 * kMargin_px) / size.y());
  return {{box.center(), {0.5 * kWidth_px, 0.5 * height_px}, scale}, height_px};
}

bool may_be_seen(const Layout& layout, const Box& box) {
  if (box.isEmpty()) return false;
  const Vector2d upper_left = layout.frame.to_px({box.min().x(), box.max().y()});
  const Vector2d size_px = layout.frame.px_per_m * box.sizes();
  return Box(upper_left, upper_left + size_px)
      .intersects(Box(Vector2d(0, 0), Vector2d(kWidth_px, layout.height_px)));
}

bool may_be_seen(const Layout& layout, const ReportLane& lane) {
  Box box;
  extend(box, lane.left);
  extend(box, lane.right);
  return may_be_seen(layout, box);
}

LineInSource outline_of(const ReportLane& lane) {
  LineInSource ring = lane.right;
  ring.insert(ring.end(), lane.left.rbegin(), lane.left.rend());
  return ring;
}

std::string lanes_svg(const ReportInput& input, const Layout& layout) {
  // Drawn in this order, so that junctions lie on top of what they join.
  constexpr std::array<std::string_view, 6> kKinds = {"other",    "walk",  "bike",
                                                      "shoulder", "drive", "junction"};
  std::map<std::string_view, std::string> areas;
  std::string borders;
  for (const ReportLane& lane : input.lanes) {
    const std::string_view look = lane_look(lane);
    if (look.empty() || !may_be_seen(layout, lane)) continue;
    areas[look] += svg_ring(layout.frame, outline_of(lane));
    if (lane.in_junction) continue;
    borders += svg_line(layout.frame, lane.left) + svg_line(layout.frame, lane.right);
  }
  std::string svg;
  for (const std::string_view look : kKinds) svg += svg_path(look, areas[look]);
  if (borders.empty()) return svg;
  // Far away, borders are thinner than a pixel, or they would hide their lanes.
  return svg + fmt::format("<path class=\"border\" stroke-width=\"{:.2f}\" d=\"{}\"/>\n",
                           std::min(0.9, 0.3 * layout.frame.px_per_m), borders);
}

std::string route_svg(const ReportInput& input, const Layout& layout) {
  std::string data;
  for (const LineInSource& leg : input.route) data += svg_line(layout.frame, leg);
  if (data.empty()) return {};
  return fmt::format("<path class=\"route\" stroke-width=\"{}\" d=\"{}\"/>\n",
                     svg_number(std::max(6.0, 2.4 * layout.frame.px_per_m)), data);
}

std::string occupied_svg(const ReportInput& input, const Layout& layout) {
  std::string data;
  for (const map::Box2& box : input.occupied) {
    const Box shown(box.min_in_source, box.max_in_source);
    if (may_be_seen(layout, shown)) data += svg_box(layout.frame, shown);
  }
  return svg_path("occupied", data);
}

double top_speed_mps(const geometry::Trajectory& drive) {
  double top_mps = 0.0;
  for (const auto& point : drive.points()) top_mps = std::max(top_mps, point.speed_mps);
  return std::max(1.0, top_mps);
}

// The driven path in pieces of one colour each, on a dark casing.
std::string driven_svg(const ReportInput& input, const Layout& layout) {
  constexpr int kShades = 24;
  const auto& points = input.drive.points();
  const double top_mps = top_speed_mps(input.drive);
  LineInSource whole;
  for (const auto& point : points) whole.push_back(point.pose().position());
  std::string svg = svg_path("casing", svg_line(layout.frame, whole));
  const auto shade = [&](std::size_t i) {
    return static_cast<int>(std::round(kShades * points[i].speed_mps / top_mps));
  };
  for (std::size_t from = 0; from + 1 < points.size();) {
    std::size_t to = from + 1;
    while (to + 1 < points.size() && shade(to) == shade(from)) ++to;
    const std::span<const Vector2d> piece(whole.begin() + static_cast<std::ptrdiff_t>(from),
                                          to - from + 1);
    svg += fmt::format("<path class=\"speed\" stroke=\"{}\" d=\"{}\"/>\n",
                       speed_colour(static_cast<double>(shade(from)) / kShades),
                       svg_line(layout.frame, piece));
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

std::string vehicle_svg(const ReportInput& input, const Layout& layout) {
  const geometry::VehicleShape& shape = input.vehicle;
  std::string bodies, labels;
  for (const double t_s : footprint_times(input.drive)) {
    const geometry::Pose2 pose = input.drive.at(t_s).pose();
    bodies += svg_ring(layout.frame,
                       body_at(pose, -shape.rear_overhang_m, shape.front_m(), shape.width_m));
    if (t_s == input.drive.start_s()) continue;  // the pin is there
    const Vector2d at_px = layout.frame.to_px(pose.position()) + left_of(pose, 16.0);
    labels += svg_text("over time mid", at_px + Vector2d(0, 4), fmt::format("{:.0f} s", t_s));
  }
  return svg_path("ego", bodies) + labels;
}

LineInSource motion_within(const planning::Obstacle& obstacle, double from_s, double to_s) {
  LineInSource line{obstacle.motion.at(from_s).pose().position()};
  for (const auto& point : obstacle.motion.points()) {
    if (point.t_s > from_s && point.t_s < to_s) line.push_back(point.pose().position());
  }
  line.push_back(obstacle.motion.at(to_s).pose().position());
  return line;
}

LineInSource obstacle_at(const planning::Obstacle& obstacle, double t_s) {
  return body_at(obstacle.motion.at(t_s).pose(), -0.5 * obstacle.length_m, 0.5 * obstacle.length_m,
                 obstacle.width_m);
}

// When the obstacle moves during the drive; empty (to before from) if it does not.
struct Span {
  double from_s = 0.0, to_s = -1.0;
};

Span moving_span(const planning::Obstacle& obstacle, const geometry::Trajectory& drive) {
  if (drive.empty() || obstacle.motion.empty() || obstacle.is_static()) return {};
  return {std::max(drive.start_s(), obstacle.motion.start_s()),
          std::min(drive.end_s(), obstacle.motion.end_s())};
}

std::string motions_svg(const ReportInput& input, const Layout& layout) {
  std::string data;
  for (const planning::Obstacle& obstacle : input.obstacles) {
    const Span span = moving_span(obstacle, input.drive);
    if (span.to_s <= span.from_s) continue;
    data += svg_line(layout.frame, motion_within(obstacle, span.from_s, span.to_s));
  }
  return svg_path("motion", data);
}

// Bodies at the times of the vehicle's footprints.
std::string obstacles_svg(const ReportInput& input, const Layout& layout) {
  std::string moving, standing;
  for (const planning::Obstacle& obstacle : input.obstacles) {
    if (obstacle.motion.empty()) continue;
    if (obstacle.is_static()) standing += svg_ring(layout.frame, obstacle_at(obstacle, 0.0));
    const Span span = moving_span(obstacle, input.drive);
    for (const double t_s : footprint_times(input.drive)) {
      if (t_s < span.from_s || t_s > span.to_s) continue;
      moving += svg_ring(layout.frame, obstacle_at(obstacle, t_s));
    }
  }
  return svg_path("moving", moving) + svg_path("standing", standing);
}

std::string pin_svg(std::string_view css_class, const Vector2d& at_px, std::string_view text) {
  return fmt::format("<path class=\"pin {}\" d=\"M{} {}l-5.7-10.4a8 8 0 1 1 11.4 0z\"/>\n",
                     css_class, svg_number(at_px.x()), svg_number(at_px.y())) +
         svg_text("over", at_px + Vector2d(11, -14), text);
}

std::string ends_svg(const ReportInput& input, const Layout& layout) {
  std::string svg;
  if (!input.drive.empty()) {
    const Vector2d start = input.drive.points().front().pose().position();
    svg += pin_svg("start", layout.frame.to_px(start), "start");
  }
  if (input.goal) svg += pin_svg("goal", layout.frame.to_px(*input.goal), "goal");
  return svg;
}

// The longest of 1, 2, 5 × 10ⁿ metres that is at most `longest_px`.
double scale_bar_m(double px_per_m, double longest_px) {
  double best_m = 1e-3;
  for (double power_m = 1e-3; power_m < 1e6; power_m *= 10.0) {
    for (const double step : {1.0, 2.0, 5.0}) {
      if (step * power_m * px_per_m <= longest_px) best_m = step * power_m;
    }
  }
  return best_m;
}

std::string scale_bar_svg(const Layout& layout) {
  const double length_m = scale_bar_m(layout.frame.px_per_m, 130.0);
  const double width_px = length_m * layout.frame.px_per_m;
  const double x = kWidth_px - 18.0 - width_px, y = layout.height_px - 16.0;
  return fmt::format("<path class=\"line\" d=\"M{0} {1}v6h{2}v-6\"/>\n", svg_number(x),
                     svg_number(y - 6.0), svg_number(width_px)) +
         svg_text("over", {x + 5.0, y - 6.0}, fmt::format("{} m", length_m));
}

std::string legend_svg(const ReportInput& input, const Layout& layout) {
  SvgLegend legend(layout.height_px + 0.5 * kSceneLegend_px + 4.0);
  if (!input.drive.empty()) {
    legend.add_speeds(top_speed_mps(input.drive));
    legend.add("class=\"ego\"", "vehicle");
  }
  if (!input.route.empty()) legend.add("fill=\"#a5d0ea\"", "route");
  const auto moving = std::ranges::count_if(
      input.obstacles, [](const planning::Obstacle& one) { return !one.is_static(); });
  if (moving > 0) legend.add("class=\"moving\"", "moving");
  if (moving < std::ssize(input.obstacles)) legend.add("class=\"standing\"", "standing");
  if (!input.occupied.empty()) legend.add("class=\"occupied\"", "occupied");
  return fmt::format("<rect class=\"strip\" y=\"{}\" width=\"{}\" height=\"{}\"/>\n",
                     svg_number(layout.height_px), svg_number(kWidth_px),
                     svg_number(kSceneLegend_px)) +
         legend.svg();
}

}  // namespace

std::string drive_scene_svg(const ReportInput& input) {
  const Layout layout = lay_out(shown_box(input));
  const std::string size = fmt::format("width=\"{}\" height=\"{}\"", svg_number(kWidth_px),
                                       svg_number(layout.height_px + kSceneLegend_px));
  std::string svg = fmt::format(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" {0} viewBox=\"0 0 {1} {2}\" role=\"img\">\n"
      "<title>{3}</title>\n{4}"
      "<clipPath id=\"card\"><rect {0} rx=\"10\"/></clipPath><g clip-path=\"url(#card)\">\n"
      "<clipPath id=\"map\"><rect width=\"{1}\" height=\"{5}\"/></clipPath>"
      "<g clip-path=\"url(#map)\"><rect class=\"ground\" width=\"{1}\" height=\"{5}\"/>\n",
      size, svg_number(kWidth_px), svg_number(layout.height_px + kSceneLegend_px),
      escape_markup(input.title), kStyle, svg_number(layout.height_px));
  svg += lanes_svg(input, layout) + route_svg(input, layout) + occupied_svg(input, layout);
  svg += motions_svg(input, layout) + driven_svg(input, layout);
  svg += obstacles_svg(input, layout) + vehicle_svg(input, layout);
  svg += ends_svg(input, layout) + scale_bar_svg(layout) + "</g>\n";
  return svg + legend_svg(input, layout) + "</g></svg>\n";
}

}  // namespace roadbed::tools
