#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

namespace roadbed::tools::inline report {

/// How a series is drawn; colours tell apart in print, too.
enum class Mark { line, dashed, thin, dots, circles, squares };

/// Colours that colour-blind eyes tell apart.
inline constexpr const char* kBlue = "#0072b2";
inline constexpr const char* kRed = "#d62728";
inline constexpr const char* kGreen = "#00785a";
inline constexpr const char* kBlack = "#10141a";

struct Series {
  std::string name;  ///< in the legend and the table; several may share one
  Mark mark = Mark::line;
  std::string colour = kBlue;
  std::vector<Eigen::Vector2d> points;
};

/// A picture of y over x with axes, units and a legend.
struct Chart {
  std::string title;
  std::string x_label, y_label;  ///< with the unit, "s [m]"
  std::vector<Series> series;
  bool is_plan = false;  ///< x and y have the same scale
};

/// The chart as an SVG document.
std::string chart_svg(const Chart& chart);

/// `series,x,y`, a row per point.
std::string chart_csv(const Chart& chart);

}  // namespace roadbed::tools::report
