#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <mutex>
#include <string>
#include <vector>

#include "roadbed/tools/support/arguments.h"

namespace roadbed::tools {

/// Hashes of what files hold, remembered by path, size and time of last change, of 10,000 files at
/// most. May be asked by several threads.
class FileHashes {
 public:
  /// XXH3 (128 bits, hexadecimal) of a file's bytes, or of the names and bytes of all files below a
  /// folder. Of what is neither, or cannot be read, a word that says so: the job says why.
  std::string of(const std::filesystem::path& path);

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

  static Stamp stamp_of(const std::filesystem::path& file);
  std::string of_file(const std::filesystem::path& file);
  std::string of_folder(const std::filesystem::path& folder);

  std::mutex mutex_;
  std::map<std::string, Known> hashes_;
  std::map<std::string, KnownNames> names_;
};

}  // namespace roadbed::tools
