#include "roadbed/tools/batch/job.h"

#include <algorithm>
#include <system_error>

#include "roadbed/map/files/read_file.h"
#include "roadbed/map/files/sha256.h"

namespace roadbed::tools::inline batch {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view kMain = "output";

// What is asked for is the option's name, and perhaps another suffix than its own.
std::string suffix_of(const ArgumentInfo& option, const std::string& asked) {
  const std::string suffix =
      asked.find('.') == std::string::npos ? option.suffix : asked.substr(asked.find('.'));
  return suffix == "/" ? "" : suffix;
}

JobOutput output_of(const ArgumentInfo& option, const std::string& asked, const std::string& hash,
                    const fs::path& folder) {
  const std::string suffix = suffix_of(option, asked), middle = "." + option.name;
  const bool says_enough = option.name == kMain || middle == suffix;
  return {.option = option.name,
          .path = folder_of_files(hash, folder) / (hash + (says_enough ? "" : middle) + suffix)};
}

const std::string* asked_for(const Job& job, const ArgumentInfo& option) {
  const auto found = std::ranges::find_if(job.outputs, [&](const std::string& asked) {
    return asked.substr(0, asked.find('.')) == option.name;
  });
  if (found != job.outputs.end()) return &*found;
  return option.is_required ? &option.name : nullptr;
}

}  // namespace

fs::path folder_of_files(const std::string& hash, const fs::path& folder) {
  return folder / "files" / hash.substr(0, 2);
}

std::vector<JobOutput> outputs_of(const Job& job, const std::string& hash, const fs::path& folder) {
  std::vector<JobOutput> outputs;
  for (const ArgumentInfo& option : job.kind->arguments) {
    if (option.use != ArgumentInfo::Use::output) continue;
    const std::string* asked = asked_for(job, option);
    if (asked != nullptr) outputs.push_back(output_of(option, *asked, hash, folder));
  }
  return outputs;
}

std::vector<std::string> files_of(const std::vector<JobOutput>& outputs, const fs::path& folder) {
  std::vector<std::string> files;
  const auto add = [&](const fs::path& file) {
    if (file.filename().native().starts_with('.')) return;  // left half-written by a killed process
    files.push_back(file.lexically_relative(folder).generic_string());
  };
  for (const JobOutput& output : outputs) {
    if (map::is_folder(output.path)) {
      for (const auto& entry : fs::recursive_directory_iterator(output.path)) {
        if (map::is_file(entry.path())) add(entry.path());
      }
    } else if (map::is_there(output.path)) {
      add(output.path);
    }
  }
  std::ranges::sort(files);
  return files;
}

std::string sha256_of_output(const fs::path& file) {
  std::error_code error;
  const bool is_empty = fs::file_size(file, error) == 0 && !error;
  return is_empty ? map::sha256_of_bytes("") : map::sha256_of_file(file);
}

void remove_files_of(const std::string& hash, const fs::path& folder) {
  std::error_code ignored;
  for (const auto& entry : fs::directory_iterator(folder_of_files(hash, folder), ignored)) {
    const std::string name = entry.path().filename().string();
    if (name.starts_with(hash) || name.starts_with("." + hash)) fs::remove_all(entry, ignored);
  }
}

}  // namespace roadbed::tools::batch
