#include "roadbed/tools/report/paper_figures.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>

#include "roadbed/map/drawing/svg.h"
#include "roadbed/map/files/csv_field.h"
#include "roadbed/map/files/xml_characters.h"

namespace roadbed::tools::inline report {
namespace {

using Eigen::Vector2d;

constexpr double kChartWidth_px = 760.0, kLeft_px = 76.0, kRight_px = 20.0;
constexpr double kTop_px = 40.0, kBottom_px = 56.0, kLegendRow_px = 20.0;
constexpr double kChartHeight_px = 340.0;
constexpr double kLeastPlanViewHeight_px = 120.0, kMostPlanViewHeight_px = 560.0;
constexpr double kTickDistance_px = 85.0;

constexpr std::string_view kChartStyle = R"(<style>
text{font:13px Helvetica,Arial,sans-serif;fill:#10141a}
.title{font-size:15px;font-weight:600}.mid{text-anchor:middle}.end{text-anchor:end}
.grid{stroke:#d9dde3;stroke-width:1;fill:none}.frame{stroke:#10141a;stroke-width:1;fill:none}
</style>
)";

// Where a point of the chart is in the picture.
struct ChartView {
  Eigen::AlignedBox2d box;
  double width_px = kChartWidth_px - kLeft_px - kRight_px;
  double height_px = kChartHeight_px;
  double top_px = kTop_px;

  Vector2d to_px(const Vector2d& point) const {
    const Vector2d fraction = (point - box.min()).cwiseQuotient(box.sizes());
    return {kLeft_px + fraction.x() * width_px, top_px + (1.0 - fraction.y()) * height_px};
  }
};

// Series that share a name have one entry.
std::vector<Series> legend_entries(const Chart& chart) {
  std::vector<Series> entries;
  for (const Series& series : chart.series) {
    const bool is_known = std::ranges::any_of(
        entries, [&](const Series& entry) { return entry.name == series.name; });
    if (!is_known) entries.push_back({series.name, series.mark, series.colour, {}});
  }
  return entries;
}

double legend_px(const Chart& chart) {
  return kLegendRow_px * static_cast<double>((legend_entries(chart).size() + 1) / 2);
}

ChartView view_of(const Chart& chart) {
  ChartView view;
  for (const Series& series : chart.series) {
    for (const Vector2d& point : series.points) view.box.extend(point);
  }
  if (view.box.isEmpty()) view.box.extend(Vector2d(0.0, 0.0));
  Vector2d margin = 0.04 * view.box.sizes();
  for (Eigen::Index i = 0; i < 2; ++i) margin[i] = std::max(margin[i], 1e-9);
  if (chart.is_plan) margin.setConstant(std::max(margin.maxCoeff(), 0.5));
  view.box = Eigen::AlignedBox2d(view.box.min() - margin, view.box.max() + margin);
  if (chart.is_plan) {
    const double asked_px = view.width_px * view.box.sizes().y() / view.box.sizes().x();
    view.height_px = std::clamp(asked_px, kLeastPlanViewHeight_px, kMostPlanViewHeight_px);
    // What is not used of one side widens the other, so that the scale stays the same.
    Vector2d wider = view.box.sizes();
    wider.x() = std::max(wider.x(), wider.y() * view.width_px / view.height_px);
    wider.y() = wider.x() * view.height_px / view.width_px;
    const Vector2d centre = view.box.center();
    view.box = Eigen::AlignedBox2d(centre - 0.5 * wider, centre + 0.5 * wider);
  }
  view.top_px = kTop_px + legend_px(chart);
  return view;
}

// 1, 2 or 5 times a power of ten.
double tick_step(double size, double ticks) {
  const double rough = size / std::max(1.0, ticks);
  const double power = std::pow(10.0, std::floor(std::log10(rough)));
  for (const double step : {1.0, 2.0, 5.0}) {
    if (step * power >= rough) return step * power;
  }
  return 10.0 * power;
}

std::string ticks_svg(const ChartView& view, Eigen::Index axis) {
  const double size_px = axis == 0 ? view.width_px : view.height_px;
  const double step = tick_step(view.box.sizes()[axis], size_px / kTickDistance_px);
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
      labels += map::svg_text("mid", {px.x(), view.top_px + view.height_px + 18.0}, label);
    } else {
      grid += fmt::format("M{} {}h{}", map::svg_number(kLeft_px), map::svg_number(px.y()),
                          map::svg_number(view.width_px));
      labels += map::svg_text("end", {kLeft_px - 7.0, px.y() + 4.0}, label);
    }
  }
  return map::svg_path("grid", grid) + labels;
}

std::string stroke(const Series& series) {
  const bool is_thin = series.mark == Mark::thin;
  return fmt::format("fill=\"none\" stroke=\"{}\" stroke-width=\"{}\"{}{}", series.colour,
                     is_thin ? "0.5" : "1.8", is_thin ? " stroke-opacity=\"0.35\"" : "",
                     series.mark == Mark::dashed ? " stroke-dasharray=\"7 4\"" : "");
}

std::string mark_svg(const Series& series, const Vector2d& px) {
  const std::string x = map::svg_number(px.x()), y = map::svg_number(px.y());
  switch (series.mark) {
    case Mark::dots:
      return fmt::format("<circle cx=\"{}\" cy=\"{}\" r=\"3.2\" fill=\"{}\"/>", x, y,
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
  return series.mark == Mark::line || series.mark == Mark::dashed || series.mark == Mark::thin;
}

std::string series_svg(const ChartView& view, const Series& series) {
  std::string svg;
  for (std::size_t i = 0; i < series.points.size(); ++i) {
    const Vector2d px = view.to_px(series.points[i]);
    svg += is_line(series) ? fmt::format("{}{:.2f} {:.2f}", i == 0 ? "M" : "L", px.x(), px.y())
                           : mark_svg(series, px);
  }
  return is_line(series) ? fmt::format("<path {} d=\"{}\"/>\n", stroke(series), svg) : svg + "\n";
}

std::string chart_legend_svg(const Chart& chart) {
  std::string svg;
  const std::vector<Series> entries = legend_entries(chart);
  for (std::size_t i = 0; i < entries.size(); ++i) {
    const double x_px = kLeft_px + (i % 2 == 0 ? 0.0 : 0.5 * (kChartWidth_px - kLeft_px));
    const double y_px = kTop_px + kLegendRow_px * static_cast<double>(i / 2);
    const Vector2d from(x_px, y_px - 4.0);
    svg += is_line(entries[i]) ? fmt::format("<path {} d=\"M{} {}h26\"/>", stroke(entries[i]),
                                             map::svg_number(from.x()), map::svg_number(from.y()))
                               : mark_svg(entries[i], {from.x() + 13.0, from.y()});
    const double most_px = 0.5 * (kChartWidth_px - kLeft_px) - 34.0;
    svg += map::svg_text_of_width("", {x_px + 34.0, y_px}, entries[i].name,
                                  std::min(map::usual_width_px(entries[i].name, 13.0), most_px));
  }
  return svg;
}

std::string labels_svg(const Chart& chart, const ChartView& view) {
  const double low_px = view.top_px + view.height_px + 42.0;
  const double middle_px = view.top_px + 0.5 * view.height_px;
  return map::svg_text("title", {kLeft_px, 20.0}, chart.title) +
         map::svg_text("mid", {kLeft_px + 0.5 * view.width_px, low_px}, chart.x_label) +
         fmt::format("<text class=\"mid\" transform=\"translate(20 {}) rotate(-90)\">{}</text>\n",
                     map::svg_number(middle_px), map::html_text(chart.y_label));
}

}  // namespace

std::string chart_svg(const Chart& chart) {
  const ChartView view = view_of(chart);
  const double height_px = view.top_px + view.height_px + kBottom_px;
  std::string svg = fmt::format(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {0} {1}\" width=\"{0}\" "
      "height=\"{1}\">\n{2}<rect width=\"100%\" height=\"100%\" fill=\"#fff\"/>\n",
      map::svg_number(kChartWidth_px), map::svg_number(height_px), kChartStyle);
  svg += ticks_svg(view, 0) + ticks_svg(view, 1);
  svg += fmt::format("<rect class=\"frame\" x=\"{}\" y=\"{}\" width=\"{}\" height=\"{}\"/>\n",
                     map::svg_number(kLeft_px), map::svg_number(view.top_px),
                     map::svg_number(view.width_px), map::svg_number(view.height_px));
  for (const Series& series : chart.series) svg += series_svg(view, series);
  return svg + chart_legend_svg(chart) + labels_svg(chart, view) + "</svg>\n";
}

std::string chart_csv(const Chart& chart) {
  fmt::memory_buffer csv;
  fmt::format_to(std::back_inserter(csv), "series,x,y\n");
  for (const Series& series : chart.series) {
    const std::string name = map::csv_field(series.name);
    for (const Vector2d& point : series.points) {
      fmt::format_to(std::back_inserter(csv), "{},{},{}\n", name, point.x(), point.y());
    }
  }
  return fmt::to_string(csv);
}

}  // namespace roadbed::tools::report
