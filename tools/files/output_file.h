#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>

#include "roadbed/map/files/input_error.h"
#include "roadbed/map/storage/chunked_file.h"

namespace roadbed::tools::inline files {

/// An output that cannot be written, for want of space or rights: no fault of the inputs.
class OutputError : public map::InputError {
 public:
  using InputError::InputError;
};

/// Checks before the work begins that `file` can be written later.
/// @throws OutputError if its folder is missing or not writable, the file is a device or a pipe, or
///         it exists and `force` is not set.
void check_writable(const std::filesystem::path& file, bool force);

/// Makes the folder (with its parents) that a command writes several files to.
/// @throws OutputError if it cannot be made, or holds something and `force` is not set.
void make_output_folder(const std::filesystem::path& folder, bool force);

/// A file that is written piece by piece: to a temporary file beside it, which is synced and
/// renamed in the end. At every moment there is the old file, or the new one, whole; without
/// `commit` nothing is left behind. Of a link, what it leads to is replaced.
class OutputFile : public map::ByteSink {
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

/// Writes a whole file in that way.
/// @throws OutputError if it cannot be written; nothing is left behind then.
void write_output(const std::filesystem::path& file, std::string_view bytes);

/// An output of many small pieces, one after the other, collected into few writes.
class BufferedOutput {
 public:
  /// @throws OutputError if it cannot be written, as do the others.
  explicit BufferedOutput(const std::filesystem::path& file) : file_(file) {}

  void add(std::string_view bytes);

  /// Puts the whole file in place; without it nothing is left behind.
  void commit();

 private:
  void flush();

  OutputFile file_;
  std::string buffer_;
  std::uint64_t written_ = 0;
};

/// A file of lines that only grows. A line is written at once, so that of a process that is killed
/// the last one may be cut off, and no other.
class AppendedFile {
 public:
  /// The file is made with its first line.
  explicit AppendedFile(std::filesystem::path file);
  ~AppendedFile();
  AppendedFile(const AppendedFile&) = delete;
  AppendedFile& operator=(const AppendedFile&) = delete;

  const std::filesystem::path& file() const { return file_; }

  /// Adds a line, without its end, and returns the byte at which it begins.
  /// @throws OutputError if it cannot be written; nothing of it stays then.
  std::uint64_t append(std::string_view line);

 private:
  void open();

  std::filesystem::path file_;
  int descriptor_ = -1;
  std::uint64_t size_ = 0;
};

}  // namespace roadbed::tools
