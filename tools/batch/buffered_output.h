#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>

#include "roadbed/tools/files/output_file.h"

namespace roadbed::tools::inline batch {

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

}  // namespace roadbed::tools
