#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>

#include "roadbed/map/files/input_error.h"
#include "roadbed/map/storage/chunked_file.h"

namespace roadbed::map::inline storage {

/// An output that cannot be written, for want of space or rights: no fault of the inputs.
class OutputError : public InputError {
 public:
  using InputError::InputError;
};

/// Checks before the work begins that `file` can be written later; `-`, standard output, always.
/// @throws OutputError if its folder is missing or not writable, the file is a device or a pipe, or
///         it exists and `force` is not set.
void check_writable(const std::filesystem::path& file, bool force);

/// Makes the folder (with its parents) that a command writes several files to.
/// @throws OutputError if it cannot be made, or holds something and `force` is not set.
void make_output_folder(const std::filesystem::path& folder, bool force);

/// A file that is written piece by piece: to a temporary file beside it, which is synced and
/// renamed in the end. At every moment there is the old file, or the new one, whole; without
/// `commit` nothing is left behind. Of a link, what it leads to is replaced.
class OutputFile : public ByteSink {
 public:
  /// @throws OutputError if it cannot be written.
  explicit OutputFile(const std::filesystem::path& file);
  ~OutputFile() override;

  /// @throws OutputError if it cannot be written.
  void write(std::uint64_t offset, std::string_view bytes) override;

  /// Puts the new file in place.
  /// @throws OutputError if it cannot be written.
  void commit();

 private:
  std::filesystem::path file_;
  std::string temporary_;  // empty: it has got its name
  int descriptor_ = -1;
};

/// Writes bytes of a file to standard output, past what makes text visible there.
/// @throws OutputError if they cannot be written.
void write_to_standard_output(std::string_view bytes);

/// Writes a whole file in that way; to standard output where it is `-`.
/// @throws OutputError if it cannot be written; nothing is left behind then.
void write_output(const std::filesystem::path& file, std::string_view bytes);

}  // namespace roadbed::map::storage
