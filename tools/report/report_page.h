#pragma once

#include <string>

#include "roadbed/tools/report/report.h"

namespace roadbed::tools::inline report {

/// One HTML page that plays the drive, from `file://`, without any other file and without network.
/// Same input, same bytes.
/// @throws std::invalid_argument if a plot's series differ in length from its times.
std::string drive_report_html(const ReportInput& input);

}  // namespace roadbed::tools::report
