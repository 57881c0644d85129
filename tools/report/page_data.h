#pragma once

#include <string>

#include "roadbed/tools/report/report.h"

namespace roadbed::tools::inline report {

/// What the page's scripts need, as one JSON document (page/decode.js reads it): points in whole
/// millimetres from an origin near the drive, series in whole steps, both as differences.
/// @throws std::invalid_argument if a plot's series differ in length from its times.
std::string page_data_json(const ReportInput& input);

}  // namespace roadbed::tools
