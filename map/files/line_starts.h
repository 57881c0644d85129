#pragma once

#include <cstddef>
#include <cstdint>
#include <string_view>
#include <vector>

namespace roadbed::map::inline files {

/// Where the lines of a text begin, for messages. O(log N) per question.
class LineStarts {
 public:
  /// @param text  at most 4 GB.
  explicit LineStarts(std::string_view text);

  /// Line of a byte, from 1.
  long line_at(std::size_t offset) const;

 private:
  std::vector<std::uint32_t> starts_;
};

}  // namespace roadbed::map::files
