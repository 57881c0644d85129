#include "roadbed/tools/batch/folder_lock.h"

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <string>
#include <string_view>
#include <system_error>
#include <vector>

#include "roadbed/map/files/read_file.h"
#include "roadbed/map/storage/output_file.h"
#include "roadbed/map/storage/output_place.h"

namespace roadbed::tools::inline batch {
namespace {

namespace fs = std::filesystem;

constexpr const char* kLock = "lock";
constexpr const char* kUnfinished = "unfinished";

constexpr std::array kOwn{kLock,           kUnfinished,    "journal",    "files",        "tables",
                          "results.jsonl", "summary.json", "index.html", "timings.jsonl"};

// Whoever puts a link in place of one of these would have the batch write elsewhere.
const fs::path& without_links(const fs::path& folder) {
  for (const char* own : kOwn) {
    std::error_code error;
    if (!fs::is_symlink(folder / own, error)) continue;
    throw map::OutputError({.file = (folder / own).string(),
                            .found = "is a link, and a batch writes into its own folder only",
                            .remedy = "remove it, or choose another folder"});
  }
  return folder;
}

int open_or_refuse(const fs::path& file) {
  const int descriptor = ::open(file.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0666);
  if (descriptor >= 0) return descriptor;
  throw map::OutputError({.file = file.string(),
                          .found = std::string("cannot be made: ") + std::strerror(errno),
                          .remedy = "choose a folder that you may write to"});
}

using IsLeft = bool (*)(const std::string& name);

// Outputs in the making have a dot before their name.
bool has_dot(const std::string& name) { return name.starts_with('.'); }

bool is_page_in_the_making(const std::string& name) {
  constexpr std::array<std::string_view, 3> starts{".results.jsonl.", ".summary.json.",
                                                   ".index.html."};
  return std::ranges::any_of(starts, [&](auto start) { return name.starts_with(start); });
}

template <typename Walk>
void remove_left(const fs::path& folder, IsLeft is_left) {
  std::error_code error;
  std::vector<fs::path> left;
  auto entry = Walk(folder, error);
  for (; !error && entry != Walk(); entry.increment(error)) {
    if (is_left(entry->path().filename().native())) left.push_back(entry->path());
  }
  for (const fs::path& path : left) fs::remove_all(path, error);
}

// Below these folders everything is the batch's own; beside them the user may keep what he likes.
void sweep(const fs::path& folder) {
  remove_left<fs::directory_iterator>(folder, is_page_in_the_making);
  for (const char* own : {"files", "journal", "tables"}) {
    remove_left<fs::recursive_directory_iterator>(folder / own, has_dot);
  }
}

}  // namespace

bool is_of_batch(const fs::path& folder) {
  std::error_code error;
  if (fs::is_directory(folder / "journal", error) || fs::exists(folder / kUnfinished, error)) {
    return true;
  }
  // What a run made first that was killed then.
  const auto is_lock = [](const fs::directory_entry& entry) {
    return entry.path().filename() == kLock;
  };
  return std::ranges::all_of(fs::directory_iterator(folder, error), is_lock);
}

void refuse_own_file(const fs::path& folder, const fs::path& jobs_file) {
  for (const char* own : kOwn) map::refuse_input(folder / own, {jobs_file});
}

FolderLock::FolderLock(const fs::path& folder)
    : descriptor_(open_or_refuse(without_links(folder) / kLock)) {
  if (::flock(descriptor_, LOCK_EX | LOCK_NB) == 0) return;
  ::close(descriptor_);
  throw map::InputError({.file = folder.string(),
                         .found = "another run is at work in it",
                         .remedy = "wait for its end, or choose another folder"});
}

FolderLock::~FolderLock() { ::close(descriptor_); }

UnfinishedMark::UnfinishedMark(const fs::path& folder) : mark_(folder / kUnfinished) {
  if (map::is_there(mark_)) sweep(folder);
  ::close(open_or_refuse(mark_));
}

void UnfinishedMark::remove() {
  std::error_code ignored;
  fs::remove(mark_, ignored);
}

}  // namespace roadbed::tools::batch
