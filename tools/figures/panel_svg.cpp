#include "roadbed/tools/figures/panel_svg.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "roadbed/map/drawing/svg.h"
#include "roadbed/tools/figures/rich_text.h"

namespace roadbed::tools::inline figures {
namespace {

using Eigen::Vector2d;

constexpr double kLeft_px = 66.0, kRight_px = 18.0, kTop_px = 12.0, kBottom_px = 50.0;
constexpr double kTitle_px = 18.0, kLegendRow_px = 19.0, kFont_px = 13.0;
constexpr double kHigh_px = 330.0, kLow_px = 190.0;
constexpr double kLeastPlan_px = 110.0, kMostPlan_px = 540.0, kMostSmallPlan_px = 260.0;
constexpr double kTickDistanceX_px = 85.0, kTickDistanceY_px = 48.0;

/// Where a point of the panel is in the picture.
struct PanelView {
  Eigen::AlignedBox2d box;
  double width_px = 0.0, height_px = 0.0, left_px = kLeft_px, top_px = 0.0;

  Vector2d to_px(const Vector2d& point) const {
    const Vector2d fraction = (point - box.min()).cwiseQuotient(box.sizes());
    return {left_px + fraction.x() * width_px, top_px + (1.0 - fraction.y()) * height_px};
  }
  std::string place(const Vector2d& point) const {
    const Vector2d px = to_px(point);
    return fmt::format("{:.2f} {:.2f}", px.x(), px.y());
  }
};

bool has_axes(const Panel& panel) { return !panel.x_label.empty() || !panel.y_label.empty(); }

Eigen::AlignedBox2d box_of(const Panel& panel) {
  Eigen::AlignedBox2d box;
  for (const Series& series : panel.series) {
    for (const Vector2d& point : series.points) box.extend(point);
  }
  for (const Body& body : panel.bodies) {
    for (const Vector2d& point : body.outline) box.extend(point);
  }
  for (const Note& note : panel.notes) box.extend(note.at);
  for (const Arrow& arrow : panel.arrows) box.extend(arrow.from).extend(arrow.to);
  if (box.isEmpty()) box.extend(Vector2d(0.0, 0.0));
  Vector2d margin = (0.04 * box.sizes()).cwiseMax(1e-9);
  if (panel.is_plan) margin.setConstant(std::max(margin.maxCoeff(), 0.5));
  return {box.min() - margin, box.max() + margin};
}

PanelView view_of(const Panel& panel, double width_px, double top_px, bool is_small) {
  PanelView view{.box = box_of(panel)};
  if (!has_axes(panel)) view.left_px = kRight_px;
  view.width_px = width_px - view.left_px - kRight_px;
  view.height_px = is_small ? kLow_px : kHigh_px;
  view.top_px = top_px;
  if (!panel.is_plan) return view;
  const double asked_px = view.width_px * view.box.sizes().y() / view.box.sizes().x();
  view.height_px = std::clamp(asked_px, kLeastPlan_px, is_small ? kMostSmallPlan_px : kMostPlan_px);
  // What is not used of one side widens the other, so that the scale stays the same.
  Vector2d wider = view.box.sizes();
  wider.x() = std::max(wider.x(), wider.y() * view.width_px / view.height_px);
  wider.y() = wider.x() * view.height_px / view.width_px;
  const Vector2d centre = view.box.center();
  view.box = Eigen::AlignedBox2d(centre - 0.5 * wider, centre + 0.5 * wider);
  return view;
}

/// 1, 2 or 5 times a power of ten.
double tick_step(double size, double ticks) {
  const double rough = size / std::max(1.0, ticks);
  const double power = std::pow(10.0, std::floor(std::log10(rough)));
  for (const double step : {1.0, 2.0, 5.0}) {
    if (step * power >= rough) return step * power;
  }
  return 10.0 * power;
}

std::string ticks_svg(const PanelView& view, Eigen::Index axis) {
  const double size_px = axis == 0 ? view.width_px : view.height_px;
  const double apart_px = axis == 0 ? kTickDistanceX_px : kTickDistanceY_px;
  const double step = tick_step(view.box.sizes()[axis], size_px / apart_px);
  std::string grid, labels;
  for (double i = std::ceil(view.box.min()[axis] / step); i * step <= view.box.max()[axis];
       i += 1.0) {
    Vector2d at = view.box.min();
    at[axis] = i * step;
    const Vector2d px = view.to_px(at);
    const std::string label = fmt::format("{:.6g}", i == 0.0 ? 0.0 : i * step);
    if (axis == 0) {
      grid += fmt::format("M{} {}v{}", map::svg_number(px.x()), map::svg_number(view.top_px),
                          map::svg_number(view.height_px));
      labels += map::svg_text("mid", {px.x(), view.top_px + view.height_px + 17.0}, label);
    } else {
      grid += fmt::format("M{} {}h{}", map::svg_number(view.left_px), map::svg_number(px.y()),
                          map::svg_number(view.width_px));
      labels += map::svg_text("end", {view.left_px - 6.0, px.y() + 4.0}, label);
    }
  }
  return map::svg_path("grid", grid) + labels;
}

std::string dashes(Mark mark) {
  switch (mark) {
    case Mark::dashed:
      return "7 4";
    case Mark::dotted:
      return "1.5 3";
    case Mark::dash_dot:
      return "8 3 1.5 3";
    case Mark::long_dash:
      return "14 4";
    case Mark::dash_dot_dot:
      return "9 3 1.5 3 1.5 3";
    default:
      return {};
  }
}

std::string stroke(const Series& series) {
  const bool is_thin = series.mark == Mark::thin;
  const std::string pattern = dashes(series.mark);
  return fmt::format("fill=\"none\" stroke=\"{}\" stroke-width=\"{}\"{}{}", series.colour,
                     is_thin ? "0.5" : "1.8", is_thin ? " stroke-opacity=\"0.35\"" : "",
                     pattern.empty() ? "" : fmt::format(" stroke-dasharray=\"{}\"", pattern));
}

std::string mark_svg(const Series& series, const Vector2d& px) {
  const std::string x = map::svg_number(px.x()), y = map::svg_number(px.y());
  switch (series.mark) {
    case Mark::dots:
      return fmt::format("<circle cx=\"{}\" cy=\"{}\" r=\"2.6\" fill=\"{}\"/>", x, y,
                         series.colour);
    case Mark::squares:
      return fmt::format(
          "<rect x=\"{}\" y=\"{}\" width=\"7\" height=\"7\" fill=\"none\" "
          "stroke=\"{}\" stroke-width=\"1.5\"/>",
          map::svg_number(px.x() - 3.5), map::svg_number(px.y() - 3.5), series.colour);
    default:
      return fmt::format(
          "<circle cx=\"{}\" cy=\"{}\" r=\"3.6\" fill=\"none\" stroke=\"{}\" "
          "stroke-width=\"1.4\"/>",
          x, y, series.colour);
  }
}

bool is_line(const Series& series) {
  return series.mark != Mark::dots && series.mark != Mark::circles && series.mark != Mark::squares;
}

std::string series_svg(const PanelView& view, const Series& series) {
  std::string svg;
  for (std::size_t i = 0; i < series.points.size(); ++i) {
    svg += is_line(series) ? (i == 0 ? "M" : "L") + view.place(series.points[i])
                           : mark_svg(series, view.to_px(series.points[i]));
  }
  return is_line(series) ? fmt::format("<path {} d=\"{}\"/>\n", stroke(series), svg) : svg + "\n";
}

std::string body_svg(const PanelView& view, const Body& body) {
  std::string ring;
  for (const Vector2d& corner : body.outline) {
    ring += (ring.empty() ? "M" : "L") + view.place(corner);
  }
  return fmt::format(
      "<path fill=\"{0}\" fill-opacity=\"0.22\" stroke=\"{0}\" stroke-width=\"1\" d=\"{1}Z\"/>\n",
      body.colour, ring);
}

/// The head's two sides.
std::string head(const Vector2d& from_px, const Vector2d& to_px) {
  const Vector2d back = 8.0 * (from_px - to_px).normalized(), across(-back.y(), back.x());
  const auto place = [](const Vector2d& px) {
    return fmt::format("{:.2f} {:.2f}", px.x(), px.y());
  };
  return "M" + place(to_px + back + 0.4 * across) + "L" + place(to_px) + "L" +
         place(to_px + back - 0.4 * across);
}

std::string arrow_svg(const PanelView& view, const Arrow& arrow) {
  const Vector2d from = view.to_px(arrow.from), to = view.to_px(arrow.to);
  if ((to - from).norm() < 1e-6) return {};
  return map::svg_path("arrow", "M" + view.place(arrow.from) + "L" + view.place(arrow.to) +
                                    head(from, to) +
                                    (arrow.has_two_heads ? head(to, from) : std::string()));
}

std::string labels_svg(const Panel& panel, const PanelView& view) {
  const double low_px = view.top_px + view.height_px + 38.0;
  const double middle_px = view.top_px + 0.5 * view.height_px;
  return rich_text_svg("mid", {view.left_px + 0.5 * view.width_px, low_px}, panel.x_label) +
         fmt::format("<g transform=\"translate(17 {}) rotate(-90)\">{}</g>\n",
                     map::svg_number(middle_px), rich_text_svg("mid", {0.0, 0.0}, panel.y_label));
}

}  // namespace

DrawnPanel legend_svg(const std::vector<Series>& series, double left_px, double width_px) {
  constexpr double kSample_px = 26.0, kGap_px = 6.0, kApart_px = 18.0;
  DrawnPanel legend;
  std::vector<std::string> known;
  double x_px = left_px;
  for (const Series& one : series) {
    if (one.name.empty() || std::ranges::find(known, one.name) != known.end()) continue;
    known.push_back(one.name);
    const double text_px = rich_text_width_px(one.name, kFont_px);
    const double whole_px = kSample_px + kGap_px + text_px;
    if (legend.height_px == 0.0) legend.height_px = kLegendRow_px;
    if (x_px > left_px && x_px + whole_px > left_px + width_px) {
      x_px = left_px;
      legend.height_px += kLegendRow_px;
    }
    const Vector2d at(x_px, legend.height_px - 6.0);
    Series sample = one;
    if (sample.mark == Mark::thin) sample.mark = Mark::line;
    legend.svg += is_line(sample) ? fmt::format("<path {} d=\"M{} {}h{}\"/>", stroke(sample),
                                                map::svg_number(at.x()),
                                                map::svg_number(at.y() - 4.0), kSample_px)
                                  : mark_svg(sample, {at.x() + 0.5 * kSample_px, at.y() - 4.0});
    legend.svg += rich_text_svg("", {at.x() + kSample_px + kGap_px, at.y()}, one.name, text_px);
    x_px += whole_px + kApart_px;
  }
  return legend;
}

DrawnPanel panel_svg(const Panel& panel, const std::string& letter, double width_px,
                     const PanelStyle& style) {
  DrawnPanel drawn;
  double top_px = kTop_px;
  const std::string title =
      letter.empty() ? panel.title : fmt::format("({}) {}", letter, panel.title);
  if (!title.empty()) {
    drawn.svg +=
        rich_text_svg("head", {has_axes(panel) ? kLeft_px : kRight_px, top_px + 6.0}, title);
    top_px += kTitle_px;
  }
  if (style.has_legend) {
    const DrawnPanel legend = legend_svg(panel.series, kLeft_px, width_px - kLeft_px - kRight_px);
    drawn.svg += fmt::format("<g transform=\"translate(0 {})\">{}</g>\n",
                             map::svg_number(top_px - 6.0), legend.svg);
    top_px += legend.height_px;
  }
  const PanelView view = view_of(panel, width_px, top_px, style.is_small);
  if (has_axes(panel)) {
    drawn.svg += ticks_svg(view, 0) + ticks_svg(view, 1);
    drawn.svg +=
        fmt::format("<rect class=\"frame\" x=\"{}\" y=\"{}\" width=\"{}\" height=\"{}\"/>\n",
                    map::svg_number(view.left_px), map::svg_number(view.top_px),
                    map::svg_number(view.width_px), map::svg_number(view.height_px));
    drawn.svg += labels_svg(panel, view);
  }
  for (const Body& body : panel.bodies) drawn.svg += body_svg(view, body);
  for (const Series& series : panel.series) drawn.svg += series_svg(view, series);
  for (const Arrow& arrow : panel.arrows) drawn.svg += arrow_svg(view, arrow);
  for (const Note& note : panel.notes) {
    drawn.svg += rich_text_svg("note", view.to_px(note.at) + Vector2d(4.0, -4.0), note.text);
  }
  drawn.height_px = view.top_px + view.height_px + (has_axes(panel) ? kBottom_px : kTop_px);
  return drawn;
}

}  // namespace roadbed::tools::figures
