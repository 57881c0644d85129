#pragma once

#include <vector>

#include "roadbed/tools/figures/figure.h"

namespace roadbed::tools::inline figures {

// Figures of the paper, computed. Captions say what is other than in the paper, and why.

/// Figs. 2–7: the reference line. The centreline of Fig. 2 is measured points of a bending road,
/// with uneven gaps and noise; Figs. 4–7 are the right angle with the gaps 3, 3 and 8 m.
std::vector<Figure> reference_line_figures();

/// Figs. 8 and 9: overtaking a slower car, planned ten times a second, and one cycle's candidates.
std::vector<Figure> lateral_planner_figures();

/// Fig. 10: the LQG loop, drawn and at work behind a lead that slows down.
Figure cruise_control_figure();

/// Figs. 11–13: what the steering law sees, L_x(v) and k_e(v).
std::vector<Figure> steering_law_figures();

/// Fig. 14: the paper's two tracking tests from 5 to 30 m/s, by the modified Stanley law, the
/// original one and pure pursuit; and what tells the laws apart, which on the path and without
/// noise they do not: from 0.2 to 30 m/s with CommonRoad's vehicle 2 on its tyres, a start 1 m
/// beside a straight, and the two tests with noise.
std::vector<Figure> tracking_figures();

}  // namespace roadbed::tools::figures
