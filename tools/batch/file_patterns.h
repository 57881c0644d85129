#pragma once

#include <string>
#include <vector>

namespace roadbed::tools::inline batch {

/// Files and folders that a pattern matches, sorted: `*`, `?` and `[…]` match within a name, `**`
/// any number of folders. Hidden ones match only where the pattern says the dot. A pattern without
/// such signs matches what it names.
std::vector<std::string> matching_files(const std::string& pattern);

}  // namespace roadbed::tools::batch
