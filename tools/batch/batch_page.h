#pragma once

#include <string>

#include "roadbed/tools/batch/batch_summary.h"

namespace roadbed::tools::inline batch {

/// One page of a batch that works offline: counts, then of each kind the worst cases first, each
/// with links to its files beside the page; in the light or the dark, as the reader's system is.
std::string batch_page(const BatchSummary& summary, const std::string& title);

}  // namespace roadbed::tools
