#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <mutex>
#include <string>
#include <utility>
#include <vector>

#include "roadbed/tools/batch/recently_used.h"
#include "roadbed/tools/cli/arguments.h"

namespace roadbed::tools::inline batch {

/// Hashes of what files hold, remembered by path, size and time of last change, of the 100,000
/// files that were asked for last. May be asked by several threads.
class FileHashes {
 public:
  /// @param is_stopped  asked while a file is read; what is not read then has no hash.
  explicit FileHashes(std::function<bool()> is_stopped) : is_stopped_(std::move(is_stopped)) {}
  FileHashes() = default;

  /// SHA-256 (hexadecimal) of a file's bytes, or of names and hashes of all files below a folder:
  /// for each, in order of names, its path in the folder, a zero byte, its hash, and a line feed.
  /// Of what is neither, or cannot be read, a word that says so: the job says why. A file is read
  /// as far as it was long at first, which ends where a log grows or a device pretends.
  /// @throws InputError for a folder with over 100,000 entries, and for one of the system's own
  ///         (/proc, /sys), whose files are none.
  std::string of(const std::filesystem::path& path);

  /// The same with the times of change: differs, too, from that of a file which has been changed
  /// and changed back since.
  std::string state_of(const std::filesystem::path& path);

  /// The files that `path` names in turn, remembered in the same way.
  std::vector<std::filesystem::path> named_in(const std::filesystem::path& path,
                                              const FilesNamed& named);

 private:
  /// What tells a file from a changed one without reading it.
  struct Stamp {
    std::uint64_t size = 0, inode = 0;
    std::int64_t modified_ns = 0, changed_ns = 0;
    bool operator==(const Stamp&) const = default;
  };
  struct Known {
    Stamp stamp;
    std::string hash;
  };
  struct KnownNames {
    Stamp stamp;
    std::vector<std::filesystem::path> names;
  };

  static constexpr std::size_t kMost = 100'000;  // some 30 MB

  static Stamp stamp_of(const std::filesystem::path& file);
  std::string read_and_hash(const std::filesystem::path& file, std::uint64_t size) const;
  bool is_stopped() const { return is_stopped_ && is_stopped_(); }
  static std::string text_of(const Known& known, bool with_stamp);
  std::string text_of(const std::filesystem::path& path, bool with_stamp);
  Known of_file(const std::filesystem::path& file);
  std::string of_folder(const std::filesystem::path& folder, bool with_stamp);

  std::function<bool()> is_stopped_;
  std::mutex mutex_;
  RecentlyUsed<Known> hashes_{kMost};
  RecentlyUsed<KnownNames> names_{kMost};
};

}  // namespace roadbed::tools::batch
