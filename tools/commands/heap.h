#pragma once

#include <filesystem>

namespace roadbed::tools::inline commands {

/// Makes ready the heap for a map that is read from `input`: kept when it is freed, as reading a
/// map takes and frees memory of many times the file's size, and for files of up to 16 MB in huge
/// pages where the system has them. Touching memory for the first time page by page is a fifth of
/// an import. Does nothing for files of more than 128 MB, or where the file is not there.
void keep_heap_in_huge_pages(const std::filesystem::path& input);

}  // namespace roadbed::tools::commands
