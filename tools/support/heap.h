#pragma once

#include <filesystem>

namespace roadbed::tools {

/// Makes ready the heap for a map that is read from `input`: in huge pages where the system has
/// them, and kept when it is freed, as reading a map takes and frees memory of many times the
/// file's size. Touching memory for the first time page by page is a fifth of an import. Does
/// nothing for files of more than 16 MB, or where the file or the memory is not there.
void keep_heap_in_huge_pages(const std::filesystem::path& input);

}  // namespace roadbed::tools
