#include "roadbed/map/files/files_named.h"

#include <algorithm>
#include <string>
#include <utility>

namespace roadbed::map::inline files {

std::vector<std::filesystem::path> files_named(const std::filesystem::path& folder,
                                               std::string_view part, std::string_view end) {
  std::vector<std::filesystem::path> files;
  std::error_code unreadable;
  for (const auto& entry : std::filesystem::directory_iterator(folder, unreadable)) {
    const std::string name = entry.path().filename().string();
    if (name.ends_with(end) && name.find(part) != name.npos) files.push_back(entry.path());
  }
  std::ranges::sort(files, {}, [](const std::filesystem::path& file) {
    const std::string name = file.filename().string();
    return std::pair(name.size(), name);
  });
  return files;
}

}  // namespace roadbed::map::files
