#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "roadbed/map/validation/finding.h"

namespace roadbed::tools::inline commands::inline maps {

/// A finding of an earlier run, by what tells it from others: not its line or its numbers, which an
/// edit elsewhere changes.
struct KnownFinding {
  std::string rule;
  std::string autoware_issue;  ///< empty where there is none
  std::string element;
  auto operator<=>(const KnownFinding&) const = default;
};

/// The findings of a document that `validate --json` printed or `--write-baseline` wrote.
/// @throws InputError if the file is missing or is no such document.
std::vector<KnownFinding> read_baseline(const std::filesystem::path& file);

/// What became of the findings of a baseline. An element may have several of one rule; as many as
/// the baseline has are known.
struct BaselineDiff {
  std::vector<bool> known;         ///< one per finding: the baseline has it, too
  std::vector<KnownFinding> gone;  ///< of the baseline, that are no more; in order
};
BaselineDiff compare_with_baseline(const std::vector<map::validation::Finding>& findings,
                                   std::vector<KnownFinding> baseline);

}  // namespace roadbed::tools::commands::maps
