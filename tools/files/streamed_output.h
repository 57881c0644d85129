#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

#include "roadbed/map/storage/output_file.h"

namespace roadbed::tools::inline files {

/// An output of many small pieces, one after the other, collected into few writes. Of `-`, standard
/// output, all is written at once in the end.
class BufferedOutput {
 public:
  /// @throws OutputError if it cannot be written, as do the others.
  BufferedOutput(const std::filesystem::path& file, bool force);

  void add(std::string_view bytes);

  /// Puts the whole file in place; without it nothing is left behind.
  void commit();

 private:
  void flush();

  std::optional<map::OutputFile> file_;  // none: standard output
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

}  // namespace roadbed::tools::files
