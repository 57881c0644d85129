#pragma once

#include <cstddef>
#include <filesystem>
#include <vector>

#include "roadbed/tools/batch/batch_summary.h"
#include "roadbed/tools/batch/result_store.h"

namespace roadbed::tools::inline batch {

/// Worst cases of each kind in `summary.json`.
constexpr std::size_t kMostInSummary = 10;

/// Writes `results.jsonl`, `summary.json` and `index.html` of a finished batch, each whole; the
/// same results give the same bytes.
/// @param order  the result of each line of the file of jobs.
/// @returns what they come to.
/// @throws InputError if a result cannot be read, OutputError if a file cannot be written.
BatchSummary write_results(const ResultStore& store, const std::vector<LineResult>& order,
                           const std::filesystem::path& folder);

}  // namespace roadbed::tools::batch
