#include "roadbed/tools/batch/folder_lock.h"

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <string>
#include <system_error>
#include <vector>

#include "roadbed/tools/support/output_file.h"

namespace roadbed::tools {
namespace {

namespace fs = std::filesystem;

int open_or_refuse(const fs::path& file) {
  const int descriptor = ::open(file.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0666);
  if (descriptor >= 0) return descriptor;
  throw OutputError({.file = file.string(),
                     .place = {},
                     .element = {},
                     .found = std::string("cannot be made: ") + std::strerror(errno),
                     .needed = {},
                     .remedy = "choose a folder that you may write to"});
}

// Outputs in the making have a dot before their name.
void sweep(const fs::path& folder) {
  std::error_code error;
  std::vector<fs::path> left;
  auto entry = fs::recursive_directory_iterator(folder, error);
  for (; !error && entry != fs::recursive_directory_iterator(); entry.increment(error)) {
    if (entry->path().filename().native().starts_with('.')) left.push_back(entry->path());
  }
  for (const fs::path& file : left) fs::remove(file, error);
}

}  // namespace

FolderLock::FolderLock(const fs::path& folder) : descriptor_(open_or_refuse(folder / "lock")) {
  if (::flock(descriptor_, LOCK_EX | LOCK_NB) == 0) return;
  ::close(descriptor_);
  throw map::InputError({.file = folder.string(),
                         .place = {},
                         .element = {},
                         .found = "another run is at work in it",
                         .needed = {},
                         .remedy = "wait for its end, or choose another folder"});
}

FolderLock::~FolderLock() { ::close(descriptor_); }

UnfinishedMark::UnfinishedMark(const fs::path& folder) : mark_(folder / "unfinished") {
  if (fs::exists(mark_)) sweep(folder);
  ::close(open_or_refuse(mark_));
}

void UnfinishedMark::remove() {
  std::error_code ignored;
  fs::remove(mark_, ignored);
}

}  // namespace roadbed::tools
