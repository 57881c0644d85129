#include <fmt/format.h>

#include <algorithm>
#include <iterator>

#include "roadbed/map/drawing/svg.h"
#include "roadbed/map/files/csv_field.h"
#include "roadbed/tools/figures/figure.h"
#include "roadbed/tools/figures/panel_svg.h"
#include "roadbed/tools/figures/rich_text.h"

namespace roadbed::tools::inline figures {
namespace {

constexpr double kSingle_px = 760.0, kColumn_px = 520.0, kMargin_px = 18.0;
constexpr double kHead_px = 30.0, kCaptionRow_px = 18.0, kCaptionFont_px = 13.0;

constexpr std::string_view kFigureStyle = R"(<style>
text{font:13px Helvetica,Arial,sans-serif;fill:#10141a}
.title{font-size:15px;font-weight:600}.head{font-weight:600}.mid{text-anchor:middle}.end{text-anchor:end}
.note{paint-order:stroke;stroke:#fff;stroke-width:3px;stroke-linejoin:round}
.grid{stroke:#d9dde3;stroke-width:1;fill:none}.frame{stroke:#10141a;stroke-width:1;fill:none}
.arrow{stroke:#10141a;stroke-width:1.2;fill:none}
</style>
)";

double width_of(const Figure& figure) {
  return figure.columns == 1 ? kSingle_px : kColumn_px * figure.columns;
}

std::string letter_of(const Figure& figure, std::size_t panel) {
  return figure.panels.size() == 1 ? "" : std::string(1, static_cast<char>('a' + panel));
}

DrawnPanel shared_legend(const Figure& figure) {
  std::vector<Series> all;
  for (const Panel& panel : figure.panels) std::ranges::copy(panel.series, std::back_inserter(all));
  return legend_svg(all, kMargin_px, width_of(figure) - 2.0 * kMargin_px);
}

std::string group(double x_px, double y_px, const std::string& svg) {
  return fmt::format("<g transform=\"translate({} {})\">\n{}</g>\n", map::svg_number(x_px),
                     map::svg_number(y_px), svg);
}

/// Panels in rows, from `top_px` on, which becomes where they end.
std::string rows_svg(const Figure& figure, double& top_px) {
  const double column_px = width_of(figure) / figure.columns;
  std::string svg;
  double row_px = 0.0;
  int column = 0;
  for (std::size_t i = 0; i < figure.panels.size(); ++i) {
    const int columns = std::min(figure.panels[i].columns, figure.columns);
    if (column + columns > figure.columns) {
      top_px += row_px;
      row_px = 0.0;
      column = 0;
    }
    const DrawnPanel drawn =
        panel_svg(figure.panels[i], letter_of(figure, i), columns * column_px,
                  {.has_legend = !figure.shares_legend, .is_small = figure.columns > 1});
    svg += group(column * column_px, top_px, drawn.svg);
    row_px = std::max(row_px, drawn.height_px);
    column += columns;
  }
  top_px += row_px;
  return svg;
}

}  // namespace

std::string figure_svg(const Figure& figure) {
  const double width_px = width_of(figure);
  double top_px = kHead_px;
  std::string svg = rich_text_svg("title", {kMargin_px, 20.0}, figure.title);
  if (figure.shares_legend) {
    const DrawnPanel legend = shared_legend(figure);
    svg += group(0.0, top_px, legend.svg);
    top_px += legend.height_px;
  }
  svg += rows_svg(figure, top_px);
  // Some fonts are wider than usual ones.
  const double caption_px = 0.86 * (width_px - 2.0 * kMargin_px);
  for (const std::string& line : wrapped(figure.caption, kCaptionFont_px, caption_px)) {
    top_px += kCaptionRow_px;
    svg += rich_text_svg("caption", {kMargin_px, top_px}, line);
  }
  return fmt::format(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {0} {1}\" width=\"{0}\" "
      "height=\"{1}\">\n{2}<rect width=\"100%\" height=\"100%\" fill=\"#fff\"/>\n{3}</svg>\n",
      map::svg_number(width_px), map::svg_number(top_px + kMargin_px), kFigureStyle, svg);
}

std::string figure_csv(const Figure& figure) {
  fmt::memory_buffer csv;
  fmt::format_to(std::back_inserter(csv), "panel,series,x,y\n");
  for (std::size_t i = 0; i < figure.panels.size(); ++i) {
    for (const Series& series : figure.panels[i].series) {
      const std::string name = map::csv_field(series.name);
      for (const Eigen::Vector2d& point : series.points) {
        fmt::format_to(std::back_inserter(csv), "{},{},{},{}\n", letter_of(figure, i), name,
                       point.x(), point.y());
      }
    }
  }
  return fmt::to_string(csv);
}

}  // namespace roadbed::tools::figures
