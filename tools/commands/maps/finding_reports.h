#pragma once

#include <cstddef>
#include <optional>
#include <string>

#include "roadbed/map/validate_file.h"
#include "roadbed/tools/commands/maps/finding_baseline.h"

// The findings of `validate` in the forms that others read. Places are the source's coordinates.

namespace roadbed::tools::inline commands::inline maps {

/// What is told of a map, and how.
struct FindingReport {
  FindingReport(const map::Validation& judged) : validation(judged) {}

  const map::Validation& validation;     ///< kept by reference
  std::optional<BaselineDiff> baseline;  ///< none: there is no baseline
  map::validation::RuleChoice choice;    ///< the rules that were asked
  bool is_complete = false;              ///< a text with every finding

  /// Whether the baseline has the finding at that place of the list.
  bool is_known(std::size_t index) const { return baseline && baseline->known[index]; }
};

/// First a line per rule with its number of findings and the first elements; then a line per
/// finding, as compilers write them, of each rule the first five; last a line with the counts.
/// Findings of the baseline are counted only.
std::string findings_text(const FindingReport& report, const std::string& file);

/// {"findings":[{"rule","asam_rule","autoware_issue","severity","element","line","x_m","y_m",
/// "message"}],"suppressed":[…]}; with a baseline, "known" of each, and "gone".
std::string findings_json(const FindingReport& report);

/// A test case per rule that was asked, failed where it found an error or a warning that is not of
/// the baseline; the others are its output.
std::string findings_junit(const FindingReport& report, const std::string& file);

/// Static Analysis Results Interchange Format 2.1.0 (OASIS), a result per finding; those that the
/// map suppresses as suppressed in source.
std::string findings_sarif(const FindingReport& report, const std::string& file);

/// A point per finding that has a place, for a map viewer; coordinates as in `export`.
std::string findings_geojson(const FindingReport& report);

/// The map's picture with a mark per finding that has a place.
/// @throws std::invalid_argument if there is no map.
std::string findings_svg(const FindingReport& report);

/// All rules as a Markdown table, as the README of map/validation holds it.
std::string rules_table();

}  // namespace roadbed::tools::commands::maps
