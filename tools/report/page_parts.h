#pragma once

#include <string>
#include <string_view>

#include "roadbed/tools/report/report.h"

namespace roadbed::tools::inline report {

// The parts of the report's page. These are files (page/) that are put into the program when it is
// built (embed.cmake).
extern const std::string_view kPageTemplate;  ///< with {{name}} where text goes
extern const std::string_view kPageCss;
extern const std::string_view kPageJs;
extern const std::string_view kDygraphsCss;
extern const std::string_view kDygraphsJs;
extern const std::string_view kSynchronizerJs;
extern const std::string_view kDygraphsLicence;  ///< plain text

// What is put where the template says {{name}}: text as HTML, in which every text of the input is
// escaped, and data.

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

/// The map around the drive, with what stands still on it, for the scripts of map/page.
std::string page_map_json(const ReportInput& input);

/// What else the page's scripts need, as one JSON document (page/decode.js reads it): points in
/// whole millimetres from an origin near the drive, series in whole steps, both as differences.
/// @throws std::invalid_argument if a plot's series differ in length from its times.
std::string page_data_json(const ReportInput& input);

}  // namespace roadbed::tools::report
