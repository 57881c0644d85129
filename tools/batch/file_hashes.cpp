#include "roadbed/tools/batch/file_hashes.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <utility>

#include "roadbed/map/files/sha256.h"

namespace roadbed::tools::inline batch {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kPiece = std::size_t{1} << 18;
constexpr std::int64_t kNanoseconds = 1'000'000'000;

std::int64_t nanoseconds(const timespec& time) {
  return static_cast<std::int64_t>(time.tv_sec) * kNanoseconds + time.tv_nsec;
}

// Piece by piece: an input may be larger than memory.
std::string hash_of_bytes(int descriptor) {
  map::Sha256 hash;
  std::vector<char> piece(kPiece);
  for (;;) {
    const ssize_t size = ::read(descriptor, piece.data(), piece.size());
    if (size < 0 && errno == EINTR) continue;
    if (size < 0) return "unreadable";
    if (size == 0) break;
    hash.add({piece.data(), static_cast<std::size_t>(size)});
  }
  return hash.take_hex();
}

std::string read_and_hash(const fs::path& file) {
  const int descriptor = ::open(file.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK);
  if (descriptor < 0) return "unreadable";
  const std::string hash = hash_of_bytes(descriptor);
  ::close(descriptor);
  return hash;
}

std::vector<fs::path> files_below(const fs::path& folder) {
  std::vector<fs::path> files;
  std::error_code error;
  auto entry = fs::recursive_directory_iterator(
      folder, fs::directory_options::skip_permission_denied, error);
  for (; !error && entry != fs::recursive_directory_iterator(); entry.increment(error)) {
    std::error_code unknown;
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
  if (fs::is_regular_file(status)) return text_of(of_file(path), with_stamp);
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
  Known read{.stamp = stamp, .hash = read_and_hash(file)};
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
