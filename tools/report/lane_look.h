#pragma once

#include <string_view>

#include "roadbed/tools/report/report.h"

namespace roadbed::tools::inline report {

/// Which of a few colours a lane has in pictures: "drive", "junction", "shoulder", "walk", "bike",
/// "other", or empty for a lane that is not drawn.
std::string_view lane_look(const ReportLane& lane);

}  // namespace roadbed::tools
