#pragma once

#include <string>

#include "roadbed/map/validate_file.h"

// The findings of `validate` in the forms that others read. Places are the source's coordinates.

namespace roadbed::tools::inline commands {

/// A line per finding, as compilers write them, and a last line with the counts.
std::string findings_text(const map::Validation& validation, const std::string& file);

/// {"findings":[{"rule","asam_rule","severity","element","line","x_m","y_m","message"}]}.
std::string findings_json(const map::Validation& validation);

/// A test case per rule, failed where it found an error or a warning; notes are its output.
std::string findings_junit(const map::Validation& validation, const std::string& file);

/// Static Analysis Results Interchange Format 2.1.0 (OASIS), a result per finding.
std::string findings_sarif(const map::Validation& validation, const std::string& file);

/// A point per finding that has a place, for a map viewer; coordinates as in `export`.
std::string findings_geojson(const map::Validation& validation);

/// The map's picture with a mark per finding that has a place.
/// @throws std::invalid_argument if there is no map.
std::string findings_svg(const map::Validation& validation);

/// All rules as a Markdown table, as the README of map/validation holds it.
std::string rules_table();

}  // namespace roadbed::tools::commands
