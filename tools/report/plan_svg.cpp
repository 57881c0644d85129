#include "roadbed/tools/report/plan_svg.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "roadbed/geometry/motion/rectangle.h"
#include "roadbed/map/drawing/svg.h"
#include "roadbed/planning/obstacles/static_obstacles.h"

namespace roadbed::tools::inline report {
namespace {

using Eigen::Vector2d;
using planning::Candidate;
using planning::Rejection;

constexpr double kPlanWidth_px = 1100.0, kLegend_px = 58.0, kTitle_px = 34.0, kSide_px = 46.0;
constexpr double kBehind_m = 4.0, kBeyond_m = 6.0;
constexpr double kLeastPlanHeight_px = 220.0, kMostHeight_px = 900.0;

struct CandidateLook {
  Rejection rejection;
  const char* css_class;
  const char* words;
};

// In the order of drawing, the least interesting below.
constexpr std::array<CandidateLook, planning::kRejections> kCandidateLooks{{
    {Rejection::off_road, "off", "leaves the road"},
    {Rejection::beyond_curvature, "bent", "beyond curvature"},
    {Rejection::lateral_acceleration, "fast", "beyond lateral acceleration"},
    {Rejection::steering_rate, "quick", "beyond the steering rate"},
    {Rejection::collision, "hit", "collides"},
    {Rejection::none, "free", "free, but dearer"},
}};

constexpr std::string_view kPlanStyle = R"(<style>
.ground{fill:#eef0ea}.road{fill:#d3d7dd}.edge{fill:none;stroke:#fff;stroke-width:2}
.line{fill:none;stroke:#0072b2;stroke-width:1.4;stroke-dasharray:8 4}
.off{fill:none;stroke:#8a8f98;stroke-width:.4;stroke-opacity:.22}
.bent{fill:none;stroke:#7b3fa0;stroke-width:.6;stroke-opacity:.45}
.fast{fill:none;stroke:#c79a00;stroke-width:.5;stroke-opacity:.35}
.quick{fill:none;stroke:#7a5cc7;stroke-width:.5;stroke-opacity:.35}
.hit{fill:none;stroke:#d62728;stroke-width:.5;stroke-opacity:.25}
.free{fill:none;stroke:#1f77b4;stroke-width:.6;stroke-opacity:.45}
.chosen{fill:none;stroke:#00785a;stroke-width:3.2;stroke-linecap:round}
.ego{fill:#00785a;fill-opacity:.14;stroke:#00583f;stroke-width:1}
.standing{fill:#e69f00;stroke:#10141a;stroke-width:.9}
.moving{fill:#d55e00;fill-opacity:.30;stroke:#d55e00;stroke-width:.9}
.now{fill:#d55e00;stroke:#10141a;stroke-width:.9}.occupied{fill:#4b3f33}
.axis{fill:none;stroke:#1b2029;stroke-width:1}.key{stroke-width:3!important;stroke-opacity:1!important}
text{font:12px system-ui,-apple-system,"Segoe UI","DejaVu Sans",sans-serif;fill:#1b2029}
.title{font-size:15px;font-weight:600}.mid{text-anchor:middle}.end{text-anchor:end}
.over{paint-order:stroke;stroke:#fff;stroke-opacity:.85;stroke-width:3px}
</style>
)";

// The picture's plane: x ahead of the vehicle, y to its left, in metres from its rear axle.
struct PlanView {
  geometry::Pose2 start_from_map;
  map::PictureFrame frame;
  Eigen::AlignedBox2d box;
  double height_px = 0.0;

  Vector2d to_start(const Vector2d& in_map) const { return start_from_map * in_map; }
};

Vector2d beside_line(const planning::LineView& line, double s_m, double d_m) {
  const planning::ReferencePoint at = line.at(s_m);
  return at.in_map + d_m * Vector2d(-std::sin(at.heading_rad), std::cos(at.heading_rad));
}

double reach_m(const PlanPicture& picture) {
  double reach = 0.0;
  for (const Candidate& candidate : picture.plan.candidates) {
    reach = std::max(reach, candidate.end_l_m);
  }
  return reach;
}

// Lines along the road: the edges, or the line itself.
std::vector<Vector2d> along(const PlanPicture& picture, const PlanView& view, int side) {
  const planning::LineView& line = picture.input.line;
  const double from_s_m = picture.input.start.s_m - kBehind_m;
  const double to_s_m = picture.input.start.s_m + reach_m(picture) + kBeyond_m;
  std::vector<Vector2d> points;
  for (int i = 0; from_s_m + 0.5 * i <= to_s_m; ++i) {
    const double s_m = from_s_m + 0.5 * i;
    const planning::Corridor corridor = line.corridor_at(s_m);
    const double d_m = side == 0 ? 0.0 : side > 0 ? corridor.left_m : -corridor.right_m;
    points.push_back(view.to_start(beside_line(line, s_m, d_m)));
  }
  return points;
}

PlanView look_from_start(const PlanPicture& picture) {
  PlanView view;
  const planning::ReferencePoint at = picture.input.line.at(picture.input.start.s_m);
  const Vector2d start =
      beside_line(picture.input.line, picture.input.start.s_m, picture.input.start.d_m);
  view.start_from_map = geometry::Pose2{start.x(), start.y(), at.heading_rad}.inverse();
  for (const int side : {-1, 1}) {
    for (const Vector2d& point : along(picture, view, side)) view.box.extend(point);
  }
  for (const Candidate& candidate : picture.plan.candidates) {
    const double s_m = picture.input.start.s_m + candidate.end_l_m;
    view.box.extend(view.to_start(beside_line(picture.input.line, s_m, candidate.end_d_m)));
  }
  const Vector2d size = view.box.sizes();
  double scale = (kPlanWidth_px - 2.0 * kSide_px) / size.x();
  scale = std::min(scale, (kMostHeight_px - 2.0 * kSide_px) / size.y());
  view.height_px = std::max(kLeastPlanHeight_px, scale * size.y() + 2.0 * kSide_px);
  view.frame = {.centre_in_plane = view.box.center(),
                .centre_px = {0.5 * kPlanWidth_px, kTitle_px + 0.5 * view.height_px},
                .px_per_m = scale};
  return view;
}

std::string road_svg(const PlanPicture& picture, const PlanView& view) {
  const std::vector<Vector2d> right = along(picture, view, -1), left = along(picture, view, 1);
  std::vector<Vector2d> ring = right;
  ring.insert(ring.end(), left.rbegin(), left.rend());
  return map::svg_path("road", map::svg_ring(view.frame, ring)) +
         map::svg_path("edge", map::svg_line(view.frame, left) + map::svg_line(view.frame, right));
}

std::string occupied_beside_plan_svg(const PlanPicture& picture, const PlanView& view) {
  const Eigen::AlignedBox2d shown(view.box.min() - Vector2d(2, 2), view.box.max() + Vector2d(2, 2));
  std::string data;
  for (const map::Box2& box : picture.occupied) {
    const Vector2d origin = picture.input.origin_in_source;
    const Vector2d low = box.min_in_source - origin, high = box.max_in_source - origin;
    if (!shown.contains(view.to_start(0.5 * (low + high)))) continue;
    geometry::Ring ring = geometry::box_ring(low, high);
    for (Vector2d& corner : ring) corner = view.to_start(corner);
    data += map::svg_ring(view.frame, ring);
  }
  return map::svg_path("occupied", data);
}

std::vector<Vector2d> candidate_line(const PlanPicture& picture, const PlanView& view,
                                     const Candidate& candidate) {
  constexpr int kSections = 15;
  const geometry::Quintic quintic =
      planning::QuinticFamily(picture.input.start, candidate.end_l_m).member(candidate.end_d_m);
  std::vector<Vector2d> points;
  for (int i = 0; i <= kSections; ++i) {
    const double l_m = candidate.end_l_m * i / kSections;
    points.push_back(view.to_start(
        beside_line(picture.input.line, picture.input.start.s_m + l_m, quintic.at(l_m)[0])));
  }
  return points;
}

std::string candidates_svg(const PlanPicture& picture, const PlanView& view) {
  std::array<std::string, planning::kRejections> data;
  for (const Candidate& candidate : picture.plan.candidates) {
    data[static_cast<std::size_t>(candidate.rejection)] +=
        map::svg_line(view.frame, candidate_line(picture, view, candidate));
  }
  std::string svg;
  for (const CandidateLook& look : kCandidateLooks) {
    svg += map::svg_path(look.css_class, data[static_cast<std::size_t>(look.rejection)]);
  }
  return svg;
}

std::string body_data(const PlanView& view, const geometry::Rectangle& body) {
  std::vector<Vector2d> ring;
  for (const Vector2d& corner : body.corners()) ring.push_back(view.to_start(corner));
  return map::svg_ring(view.frame, ring);
}

bool is_shown(const PlanView& view, const geometry::Rectangle& body) {
  return view.box.squaredExteriorDistance(view.to_start(body.centre)) < 9.0;
}

// Times at which moving things are drawn: now and at whole seconds until the drive ends.
std::vector<double> shown_times(const PlanPicture& picture) {
  const double start_s = picture.input.start_t_s;
  const double end_s =
      picture.plan.chosen ? std::min(picture.plan.trajectory.end_s(), start_s + 5.0) : start_s;
  std::vector<double> times;
  for (int i = 0; start_s + i <= end_s; ++i) times.push_back(start_s + i);
  return times;
}

std::string planned_obstacles_svg(const PlanPicture& picture, const PlanView& view) {
  std::string standing, moving, now;
  for (const planning::Obstacle& obstacle : picture.obstacles) {
    for (const double t_s : shown_times(picture)) {
      const geometry::Rectangle body = planning::rectangle_at(obstacle, t_s);
      if (!obstacle.is_there(t_s) || !is_shown(view, body)) continue;
      const bool first = t_s == picture.input.start_t_s;
      if (obstacle.is_static() && !first) continue;
      (obstacle.is_static() ? standing : first ? now : moving) += body_data(view, body);
    }
  }
  return map::svg_path("moving", moving) + map::svg_path("now", now) +
         map::svg_path("standing", standing);
}

std::string chosen_svg(const PlanPicture& picture, const PlanView& view) {
  if (!picture.plan.chosen) return {};
  const Candidate& chosen = *picture.plan.chosen;
  std::string bodies, times;
  for (const double t_s : shown_times(picture)) {
    const geometry::Pose2 pose = picture.plan.trajectory.at(t_s).pose();
    bodies += body_data(view, geometry::body_at(pose, picture.vehicle));
    times += map::svg_text("over mid",
                           view.frame.to_px(view.to_start(pose.position())) + Vector2d(0, -6),
                           fmt::format("{:g} s", t_s));
  }
  return map::svg_path("ego", bodies) +
         map::svg_path("chosen", map::svg_line(view.frame, candidate_line(picture, view, chosen))) +
         times;
}

// Metres ahead along the lower side, metres to the left along the left side.
std::string axes_svg(const PlanView& view) {
  const double left_px = kSide_px - 8.0, low_px = kTitle_px + view.height_px - kSide_px + 10.0;
  std::string ticks, labels;
  const auto first = [](double least, double step) {
    return static_cast<int>(std::ceil(least / step));
  };
  for (int i = first(view.box.min().x(), 5.0); 5.0 * i <= view.box.max().x(); ++i) {
    const double at_px = view.frame.to_px({5.0 * i, 0.0}).x();
    ticks += fmt::format("M{} {}v6", map::svg_number(at_px), map::svg_number(low_px));
    labels += map::svg_text("mid", {at_px, low_px + 19.0}, fmt::format("{}", 5 * i));
  }
  const int step_m = view.box.sizes().y() > 30.0 ? 5 : 2;
  for (int i = first(view.box.min().y(), step_m); step_m * i <= view.box.max().y(); ++i) {
    const double at_px = view.frame.to_px({0.0, 1.0 * step_m * i}).y();
    ticks += fmt::format("M{} {}h-6", map::svg_number(left_px), map::svg_number(at_px));
    labels += map::svg_text("end", {left_px - 9.0, at_px + 4.0}, fmt::format("{}", step_m * i));
  }
  labels += map::svg_text("end", {kPlanWidth_px - 8.0, low_px + 19.0}, "m ahead");
  labels += map::svg_text("", {6.0, kTitle_px + 10.0}, "m left");
  return map::svg_path("axis", ticks) + labels;
}

struct LegendKey {
  std::string css_class, words;
};

std::vector<LegendKey> legend_of(const planning::Plan& plan) {
  std::array<std::size_t, planning::kRejections> counts{};
  for (const Candidate& candidate : plan.candidates) {
    ++counts[static_cast<std::size_t>(candidate.rejection)];
  }
  std::vector<LegendKey> keys;
  for (const CandidateLook& look : kCandidateLooks) {
    const std::size_t count = counts[static_cast<std::size_t>(look.rejection)];
    keys.push_back(
        {fmt::format("{} key", look.css_class), fmt::format("{} ({})", look.words, count)});
  }
  keys.push_back({"chosen", "chosen, with the vehicle at whole seconds"});
  keys.push_back({"line", "reference line"});
  return keys;
}

/// In rows, none of which is cut whatever the font.
std::string candidates_legend_svg(const PlanPicture& picture, const PlanView& view) {
  constexpr double kKey_px = 28.0, kFont_px = 12.0, kBetween_px = 16.0, kRow_px = 22.0;
  std::string svg;
  double x_px = kSide_px, y_px = kTitle_px + view.height_px + 16.0;
  for (const LegendKey& key : legend_of(picture.plan)) {
    const double words_px = map::usual_width_px(key.words, kFont_px);
    const double width_px = kKey_px + words_px;
    if (x_px + width_px > kPlanWidth_px) {
      x_px = kSide_px;
      y_px += kRow_px;
    }
    svg += map::svg_path(key.css_class, fmt::format("M{} {}h22", map::svg_number(x_px),
                                                    map::svg_number(y_px - 4.0)));
    svg += map::svg_text_of_width("", {x_px + kKey_px, y_px}, key.words, words_px);
    x_px += width_px + kBetween_px;
  }
  return svg;
}

}  // namespace

std::string plan_svg(const PlanPicture& picture) {
  const PlanView view = look_from_start(picture);
  const double height_px = kTitle_px + view.height_px + kLegend_px;
  std::string svg = fmt::format(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {0} {1}\" width=\"{0}\" "
      "height=\"{1}\">\n",
      kPlanWidth_px, map::svg_number(height_px));
  svg += kPlanStyle;
  svg += "<rect width=\"100%\" height=\"100%\" fill=\"#fff\"/>\n";
  svg += fmt::format("<rect class=\"ground\" y=\"{}\" width=\"100%\" height=\"{}\"/>\n", kTitle_px,
                     map::svg_number(view.height_px));
  svg += road_svg(picture, view) + occupied_beside_plan_svg(picture, view) +
         candidates_svg(picture, view);
  svg += map::svg_path("line", map::svg_line(view.frame, along(picture, view, 0)));
  svg += planned_obstacles_svg(picture, view) + chosen_svg(picture, view) + axes_svg(view);
  svg += map::svg_text("title", {kSide_px, 22.0}, picture.title) +
         candidates_legend_svg(picture, view);
  return svg + "</svg>\n";
}

}  // namespace roadbed::tools::report
