#pragma once

#include <cstddef>
#include <filesystem>
#include <vector>

#include "roadbed/map/validation/finding.h"
#include "roadbed/map/validation/rule_choice.h"

namespace roadbed::tools::inline commands::inline maps {

/// The findings of a document that `validate --json` printed or `--write-baseline` wrote: their
/// rules, elements and severities. One without a severity is an error.
/// @throws InputError if the file is missing or is no such document.
std::vector<map::validation::Finding> read_baseline(const std::filesystem::path& file);

/// What became of the findings of a baseline. They are told from others by rule, issue and element:
/// not by line or numbers, which an edit elsewhere changes. An element may have several of one
/// rule; as many as the baseline has are known, unless they have become graver.
struct BaselineDiff {
  std::vector<bool> known;                     ///< one per finding: the baseline has it, too
  std::vector<map::validation::Finding> gone;  ///< of the baseline, that are no more; in order
  std::size_t unasked = 0;                     ///< of the baseline, that no rule was asked about
};
BaselineDiff compare_with_baseline(const std::vector<map::validation::Finding>& findings,
                                   std::vector<map::validation::Finding> baseline,
                                   const map::validation::RuleChoice& choice);

}  // namespace roadbed::tools::commands::maps
