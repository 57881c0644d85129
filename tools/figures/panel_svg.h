#pragma once

#include <string>
#include <vector>

#include "roadbed/tools/figures/figure.h"

namespace roadbed::tools::inline figures {

// Private to figure_svg.cpp: one panel, whose upper left corner is (0, 0).

struct DrawnPanel {
  std::string svg;
  double height_px = 0.0;
};

/// @param letter      before its title; empty: it is the only one.
/// How a figure draws its panels.
struct PanelStyle {
  bool has_legend = true;  ///< each its own
  bool is_small = false;   ///< one of several beside each other
};

DrawnPanel panel_svg(const Panel& panel, const std::string& letter, double width_px,
                     const PanelStyle& style);

/// Entries of a legend, in rows as wide as there is room; series that share a name have one.
DrawnPanel legend_svg(const std::vector<Series>& series, double left_px, double width_px);

}  // namespace roadbed::tools::figures
