#include "roadbed/tools/batch/file_patterns.h"

#include <fnmatch.h>

#include <algorithm>
#include <filesystem>
#include <system_error>

namespace roadbed::tools::inline batch {
namespace {

namespace fs = std::filesystem;

using Parts = std::vector<std::string>;

bool is_pattern(const std::string& part) { return part.find_first_of("*?[") != std::string::npos; }

std::vector<fs::path> entries_of(const fs::path& folder) {
  std::vector<fs::path> entries;
  std::error_code error;
  auto entry = fs::directory_iterator(folder.empty() ? "." : folder, error);
  for (; !error && entry != fs::directory_iterator(); entry.increment(error)) {
    entries.push_back(folder / entry->path().filename());
  }
  return entries;
}

bool is_folder(const fs::path& path) {
  std::error_code error;
  return fs::is_directory(path, error) && !fs::is_symlink(path, error);
}

void match(const fs::path& folder, Parts::const_iterator part, Parts::const_iterator end,
           std::vector<std::string>& found) {
  if (part == end) {
    std::error_code error;
    if (fs::exists(folder, error)) found.push_back(folder.string());
    return;
  }
  if (!is_pattern(*part)) return match(folder / *part, part + 1, end, found);
  if (*part == "**") match(folder, part + 1, end, found);
  for (const fs::path& entry : entries_of(folder)) {
    const std::string name = entry.filename().string();
    if (*part == "**") {
      if (is_folder(entry) && !name.starts_with('.')) match(entry, part, end, found);
    } else if (::fnmatch(part->c_str(), name.c_str(), FNM_PERIOD) == 0) {
      match(entry, part + 1, end, found);
    }
  }
}

}  // namespace

std::vector<std::string> matching_files(const std::string& pattern) {
  Parts parts;
  for (const fs::path& part : fs::path(pattern)) parts.push_back(part.string());
  std::vector<std::string> found;
  match({}, parts.begin(), parts.end(), found);
  std::ranges::sort(found);
  found.erase(std::unique(found.begin(), found.end()), found.end());
  return found;
}

}  // namespace roadbed::tools::batch
