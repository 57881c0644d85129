#include <algorithm>
#include <set>
#include <string>

#include "roadbed/map/files/input_error.h"
#include "roadbed/map/files/read_file.h"
#include "roadbed/map/logs/containers.h"

namespace roadbed::map::inline logs {
namespace {

namespace fs = std::filesystem;

constexpr const char* kMetadata = "metadata.yaml";

std::string_view trimmed(std::string_view text, std::string_view signs) {
  const std::size_t begin = std::min(text.find_first_not_of(signs), text.size());
  text.remove_prefix(begin);
  return text.substr(0, text.find_last_not_of(signs) + 1);
}

std::string_view take_line(std::string_view& rest) {
  const std::size_t end = rest.find('\n');
  const std::string_view line = rest.substr(0, end);
  rest.remove_prefix(end == std::string_view::npos ? rest.size() : end + 1);
  return line;
}

}  // namespace

std::vector<fs::path> files_of_bag(const fs::path& folder) {
  return files_in_metadata(read_file(folder / kMetadata), folder);
}

// Of YAML just the list that rosbag2 writes: "relative_file_paths:", then "- NAME" a line.
std::vector<fs::path> files_in_metadata(std::string_view text, const fs::path& folder) {
  const auto refuse = [&](const std::string& found) {
    throw InputError({.file = (folder / kMetadata).string(),
                      .element = "relative_file_paths",
                      .found = found,
                      .needed = "names of files in the bag's folder, a line each",
                      .remedy = "make it anew by `ros2 bag reindex`, or name the bag's file"});
  };
  std::vector<fs::path> files;
  std::set<std::string> names;
  bool is_listing = false;
  for (std::string_view rest = text; !rest.empty();) {
    const std::string_view line = trimmed(take_line(rest), " \t\r");
    if (line == "relative_file_paths:") {
      is_listing = true;
    } else if (is_listing && line.starts_with('-')) {
      const fs::path name(trimmed(line.substr(1), " \"'"));
      if (name.empty() || name.is_absolute() || std::ranges::find(name, "..") != name.end()) {
        refuse("\"" + name.string() + "\"");
      }
      if (!names.insert(name.string()).second) refuse("\"" + one_line(name.string()) + "\" again");
      files.push_back(folder / name);
    } else if (is_listing) {
      break;
    }
  }
  if (files.empty()) refuse("none");
  return files;
}

}  // namespace roadbed::map::logs
