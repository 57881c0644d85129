#pragma once

#include <string>

#include "roadbed/tools/report/report.h"

namespace roadbed::tools::inline report {

/// The whole drive as one picture on its own background, 900 wide: lanes, route, driven path
/// coloured by speed, footprints every few seconds, obstacles, scale bar and legend. Same input,
/// same bytes.
std::string drive_scene_svg(const ReportInput& input);

}  // namespace roadbed::tools::report
