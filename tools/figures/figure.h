#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

namespace roadbed::tools::inline figures {

// Texts may have `_x` or `_{fa}` for what stands below the line, `^2` or `^{−1}` for what stands
// above it.

/// How a series is drawn. Lines differ by their dashes, too, so that print tells them apart.
enum class Mark {
  line,
  dashed,
  dotted,
  dash_dot,
  long_dash,
  dash_dot_dot,
  thin,
  dots,
  circles,
  squares
};

/// Colours that colour-blind eyes tell apart.
inline constexpr const char* kBlue = "#0072b2";
inline constexpr const char* kRed = "#d62728";
inline constexpr const char* kGreen = "#00785a";
inline constexpr const char* kOrange = "#b8860b";
inline constexpr const char* kViolet = "#7b3294";
inline constexpr const char* kBlack = "#10141a";
inline constexpr const char* kGrey = "#8a94a3";

struct Series {
  std::string name;  ///< in the legend and the table; several may share one
  Mark mark = Mark::line;
  std::string colour = kBlue;
  std::vector<Eigen::Vector2d> points;
};

/// A thing at its true size: the outline of a vehicle, drawn below the series.
struct Body {
  std::vector<Eigen::Vector2d> outline;
  std::string colour = kBlue;
};

/// A word at a place, to its upper right.
struct Note {
  Eigen::Vector2d at{0, 0};
  std::string text;
};

/// From a place to another, with a head there, or at both ends.
struct Arrow {
  Eigen::Vector2d from{0, 0}, to{0, 0};
  bool has_two_heads = false;
};

/// A picture of y over x with axes, units and a legend; or a drawing without axes.
struct Panel {
  std::string title = {};                  ///< after its letter; may be empty
  std::string x_label = {}, y_label = {};  ///< with the unit, "s [m]"; both empty: no axes
  std::vector<Series> series = {};
  bool is_plan = false;  ///< x and y have the same scale
  std::vector<Body> bodies = {};
  std::vector<Note> notes = {};
  std::vector<Arrow> arrows = {};
  int columns = 1;  ///< of its figure, that it takes
};

struct Figure {
  std::string name;   ///< of its files, without suffix
  std::string title;  ///< "Fig. 8: avoiding a moving obstacle"
  std::vector<Panel> panels;
  std::string caption;         ///< what is shown, and what is other than in the paper, and why
  int columns = 1;             ///< of panels
  bool shares_legend = false;  ///< one for all panels, above them
};

/// The figure as an SVG document: panels with letters, and the caption below.
std::string figure_svg(const Figure& figure);

/// `panel,series,x,y`, a row per point; panels by letter.
std::string figure_csv(const Figure& figure);

}  // namespace roadbed::tools::figures
