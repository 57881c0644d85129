#include "roadbed/tools/batch/file_hashes.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <linux/magic.h>
#include <sys/stat.h>
#include <sys/statfs.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <utility>

#include "roadbed/map/files/input_error.h"
#include "roadbed/map/files/sha256.h"

namespace roadbed::tools::inline batch {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kPiece = std::size_t{1} << 18;
constexpr std::int64_t kNanoseconds = 1'000'000'000;

std::int64_t nanoseconds(const timespec& time) {
  return static_cast<std::int64_t>(time.tv_sec) * kNanoseconds + time.tv_nsec;
}

constexpr std::size_t kMostEntries = 100'000;

[[noreturn]] void refuse_input_folder(const fs::path& folder, const std::string& found) {
  throw map::InputError({.file = folder.string(),
                         .found = found,
                         .needed = "a folder of inputs",
                         .remedy = "name the folder that holds the inputs and little else"});
}

// Where files are made up when read: without an end, or another one each time.
bool is_of_the_system(const fs::path& path) {
  struct statfs system {};
  if (::statfs(path.c_str(), &system) != 0) return false;
  return system.f_type == PROC_SUPER_MAGIC || system.f_type == SYSFS_MAGIC;
}

std::vector<fs::path> files_below(const fs::path& folder) {
  if (is_of_the_system(folder)) refuse_input_folder(folder, "is a folder of the system's own");
  std::vector<fs::path> files;
  std::size_t entries = 0;
  std::error_code error;
  auto entry = fs::recursive_directory_iterator(
      folder, fs::directory_options::skip_permission_denied, error);
  for (; !error && entry != fs::recursive_directory_iterator(); entry.increment(error)) {
    if (++entries > kMostEntries) {
      refuse_input_folder(folder, fmt::format("holds over {} files and folders", kMostEntries));
    }
    std::error_code unknown;
    if (entry->is_directory(unknown) && is_of_the_system(entry->path())) {
      entry.disable_recursion_pending();
    }
    if (entry->is_regular_file(unknown)) files.push_back(entry->path());
  }
  std::ranges::sort(files);
  return files;
}

// The job itself says what is wrong with a file that cannot be read.
std::vector<fs::path> names_in(const fs::path& path, const FilesNamed& named) {
  try {
    return named(path);
  } catch (const fs::filesystem_error&) {
    return {};
  }
}

}  // namespace

// Piece by piece: an input may be larger than memory.
std::string FileHashes::read_and_hash(const fs::path& file, std::uint64_t size) const {
  const int descriptor = ::open(file.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK);
  if (descriptor < 0) return "unreadable";
  map::Sha256 hash;
  std::vector<char> piece(kPiece);
  bool is_read = true;
  for (std::uint64_t left = size; left > 0 && is_read;) {
    const ssize_t count = ::read(descriptor, piece.data(), std::min<std::uint64_t>(kPiece, left));
    if (count < 0 && errno == EINTR) continue;
    if (count == 0) break;
    is_read = count > 0 && !is_stopped();
    if (!is_read) break;
    hash.add({piece.data(), static_cast<std::size_t>(count)});
    left -= static_cast<std::uint64_t>(count);
  }
  ::close(descriptor);
  return is_read ? hash.take_hex() : "unreadable";
}

FileHashes::Stamp FileHashes::stamp_of(const fs::path& file) {
  struct stat status {};
  if (::stat(file.c_str(), &status) != 0) return {};
  return {.size = static_cast<std::uint64_t>(status.st_size),
          .inode = static_cast<std::uint64_t>(status.st_ino),
          .modified_ns = nanoseconds(status.st_mtim),
          .changed_ns = nanoseconds(status.st_ctim)};
}

std::string FileHashes::of(const fs::path& path) { return text_of(path, false); }

std::string FileHashes::state_of(const fs::path& path) { return text_of(path, true); }

std::string FileHashes::text_of(const fs::path& path, bool with_stamp) {
  std::error_code error;
  const fs::file_status status = fs::status(path, error);
  if (fs::is_directory(status)) return of_folder(path, with_stamp);
  if (fs::is_regular_file(status) && !is_of_the_system(path)) {
    return text_of(of_file(path), with_stamp);
  }
  return fs::exists(status) ? "no regular file" : "missing";
}

std::string FileHashes::text_of(const Known& known, bool with_stamp) {
  if (!with_stamp) return known.hash;
  const Stamp& stamp = known.stamp;
  return fmt::format("{} {} {} {} {}", known.hash, stamp.size, stamp.inode, stamp.modified_ns,
                     stamp.changed_ns);
}

FileHashes::Known FileHashes::of_file(const fs::path& file) {
  const Stamp stamp = stamp_of(file);
  {
    const std::scoped_lock lock(mutex_);
    const Known* const known = hashes_.find(file.native());
    if (known != nullptr && known->stamp == stamp) return *known;
  }
  Known read{.stamp = stamp, .hash = read_and_hash(file, stamp.size)};
  const std::scoped_lock lock(mutex_);
  return hashes_.put(file.native(), std::move(read));
}

std::string FileHashes::of_folder(const fs::path& folder, bool with_stamp) {
  std::string names_and_hashes;
  for (const fs::path& file : files_below(folder)) {
    names_and_hashes += file.lexically_relative(folder).generic_string() + '\0' +
                        text_of(of_file(file), with_stamp) + '\n';
  }
  return map::sha256_of_bytes(names_and_hashes);
}

std::vector<fs::path> FileHashes::named_in(const fs::path& path, const FilesNamed& named) {
  std::error_code error;
  if (!named || !fs::exists(path, error)) return {};
  if (fs::is_directory(path, error)) return names_in(path, named);
  const Stamp stamp = stamp_of(path);
  {
    const std::scoped_lock lock(mutex_);
    const KnownNames* const known = names_.find(path.native());
    if (known != nullptr && known->stamp == stamp) return known->names;
  }
  std::vector<fs::path> names = names_in(path, named);
  const std::scoped_lock lock(mutex_);
  return names_.put(path.native(), {stamp, std::move(names)}).names;
}

}  // namespace roadbed::tools::batch
