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

/// A figure of the paper, computed.
struct Figure {
  std::string name;  ///< of its files, without suffix
  Chart chart;
};

/// Figs. 2–7: the reference line. The centreline of Fig. 2 is measured points of a bending road,
/// with uneven gaps and noise; Figs. 4–7 are the right angle with the gaps 3, 3 and 8 m.
std::vector<Figure> reference_line_figures();

/// Figs. 8 and 9: overtaking a slower car, planned ten times a second, and one cycle's candidates.
std::vector<Figure> lateral_planner_figures();

/// Figs. 10 and 12–14: the LQG loop at work, L_x(v) and k_e(v), and the paper's two tracking tests
/// from 5 to 30 m/s: errors, steering rate and lateral jerk over time, and the largest of each
/// beside those of the original Stanley law and of pure pursuit.
std::vector<Figure> tracking_figures();

/// What tells the laws of Fig. 14 apart, which on the path and without noise they do not: from 0.2
/// to 30 m/s with CommonRoad's vehicle 2 on its tyres, a start 1 m beside a straight (steering
/// angle, way back), and the paper's two tests with noise (error, steering rate).
std::vector<Figure> steering_law_figures();

}  // namespace roadbed::tools::report
