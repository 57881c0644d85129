#pragma once

namespace roadbed::tools::inline cli {

/// From now on memory that is freed stays in the heap until the process ends, large blocks as well:
/// for work that takes and frees them again and again, as new pages cost a page fault for each 4
/// kB.
void keep_freed_memory();

}  // namespace roadbed::tools::cli
