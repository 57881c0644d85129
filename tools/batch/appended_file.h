#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>

namespace roadbed::tools::inline batch {

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
