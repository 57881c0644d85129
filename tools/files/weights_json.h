#pragma once

#include <filesystem>
#include <string_view>

#include "roadbed/planning/lateral/cost_terms.h"

namespace roadbed::tools::inline files {

/// Reads weights of the planner's cost: a JSON object `{"offset": 1.5, "time": 0}`. Keys are the
/// terms' names; a term that is not named keeps its default.
/// @throws InputError for an unknown term, or a weight that is not a number from 0 to 1e6.
planning::CostTerms read_weights(const std::filesystem::path& file);

/// The same from bytes; `name` stands for the file in messages.
planning::CostTerms parse_weights(std::string_view bytes, const std::string& name);

}  // namespace roadbed::tools::files
