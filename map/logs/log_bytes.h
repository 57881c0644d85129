#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>

namespace roadbed::map::inline logs {

/// Bytes that are read piece by piece: of a plain file, or in memory. Not for several threads.
class LogBytes {
 public:
  /// @throws InputError if the file cannot be opened.
  explicit LogBytes(const std::filesystem::path& file);
  /// Of bytes that outlive it.
  LogBytes(std::string_view bytes, std::string name);
  ~LogBytes();
  LogBytes(const LogBytes&) = delete;
  LogBytes& operator=(const LogBytes&) = delete;

  const std::string& name() const { return name_; }
  std::uint64_t size() const { return size_; }

  /// Bytes from `offset` on, valid until the next call.
  /// @throws InputError if there are fewer than `count`.
  std::string_view read(std::uint64_t offset, std::uint64_t count);

 private:
  std::string name_, buffer_;
  std::string_view bytes_;
  int descriptor_ = -1;
  std::uint64_t size_ = 0;
};

}  // namespace roadbed::map::logs
