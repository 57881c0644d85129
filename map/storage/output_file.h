#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "roadbed/map/storage/chunked_file.h"
#include "roadbed/map/storage/output_place.h"

namespace roadbed::map::inline storage {

/// Checks before the work begins that `file` can be written later; `-`, standard output, always.
/// @throws OutputError if its folder is missing or not writable, the file is a device or a pipe, it
///         exists and `force` is not set, or its place cannot be looked at, see look_at_output.
void check_writable(const std::filesystem::path& file, bool force);

/// A file that is written piece by piece: without a name where the file system has such files, else
/// to a hidden one beside it; synced, and named in the end. At every moment there is the old file,
/// or the new one, whole; without `commit` nothing is left behind, and what a kill left is removed
/// when the same output is written again. Of a link, what it leads to is replaced. The new file has
/// the permissions of the one that it replaces.
class OutputFile : public ByteSink {
 public:
  /// @param force  what is there is replaced, also what others make there meanwhile.
  /// @throws OutputError if it cannot be written.
  explicit OutputFile(const std::filesystem::path& file, bool force);
  ~OutputFile() override;

  /// @throws OutputError if it cannot be written.
  void write(std::uint64_t offset, std::string_view bytes) override;

  /// Waits until what was written is on the disk, which a full one says at the latest here.
  /// @throws OutputError if it cannot be written.
  void sync();

  /// Puts the new file in place, synced.
  /// @throws OutputError if it cannot be written, or without `force` if there is a file by now.
  void commit();

 private:
  bool give_name(const std::filesystem::path& name) const;
  bool put_at_free_name();
  void replace();

  OutputPlace place_;
  bool force_;
  std::filesystem::path hidden_;  // its name in the making; empty: it has none, or its own
  int descriptor_ = -1;
};

/// Writes bytes of a file to standard output, past what makes text visible there.
/// @throws OutputError if they cannot be written.
void write_to_standard_output(std::string_view bytes);

/// Writes a whole file in that way; to standard output where it is `-`.
/// @throws OutputError if it cannot be written; nothing is left behind then.
void write_output(const std::filesystem::path& file, std::string_view bytes, bool force);

/// Files of one answer: all are on the disk before the first is put in place, so that a disk that
/// is full leaves none.
class OutputFiles {
 public:
  explicit OutputFiles(bool force) : force_(force) {}

  /// @param file  `-` is standard output, in its turn at the commit.
  /// @throws OutputError if it cannot be written.
  void add(const std::filesystem::path& file, std::string_view bytes);

  /// @throws OutputError as OutputFile does.
  void commit();

 private:
  bool force_;
  std::vector<std::unique_ptr<OutputFile>> files_;
  std::string to_standard_output_;
};

}  // namespace roadbed::map::storage
