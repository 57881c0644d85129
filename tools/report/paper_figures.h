#pragma once

#include <string>
#include <vector>

#include "roadbed/tools/report/chart.h"

namespace roadbed::tools::inline report {

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

}  // namespace roadbed::tools::report
