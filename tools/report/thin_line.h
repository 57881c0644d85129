#pragma once

#include "roadbed/tools/report/report.h"

namespace roadbed::tools::inline report {

/// The points of a line that a picture needs: no dropped point is farther than `tolerance_m` from
/// the segment that replaces it (Douglas and Peucker 1973). The ends stay.
LineInSource thin_line(const LineInSource& line, double tolerance_m);

}  // namespace roadbed::tools
