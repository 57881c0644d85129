#pragma once

#include <string>

#include "roadbed/tools/report/report.h"

namespace roadbed::tools::inline report {

// The parts of the page that are text, as HTML; every text of the input is escaped.

/// Title, scenario, verdicts and the drive's main figures.
std::string page_head(const ReportInput& input);

/// Table of what was checked, in the order of the input; values are rounded to three decimals.
std::string page_checks(const ReportInput& input);

/// Drawings of moments, each with a link to it; nothing if there are none.
std::string page_pictures(const ReportInput& input);

/// What happened when; a click goes to the moment.
std::string page_events(const ReportInput& input);

/// Command, version, coordinates and inputs.
std::string page_foot(const ReportInput& input);

}  // namespace roadbed::tools
