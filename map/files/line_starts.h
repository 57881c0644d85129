#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <string_view>
#include <vector>

namespace roadbed::map::inline files {

/// Where the lines of a text begin, for messages. O(log N) per question.
class LineStarts {
 public:
  /// @param text  at most 4 GB.
  explicit LineStarts(std::string_view text) : starts_{0} {
    for (auto end = text.find('\n'); end != text.npos; end = text.find('\n', end + 1)) {
      starts_.push_back(static_cast<std::uint32_t>(end + 1));
    }
  }

  /// Line of a byte, from 1.
  long line_at(std::size_t offset) const {
    return static_cast<long>(std::upper_bound(starts_.begin(), starts_.end(), offset) -
                             starts_.begin());
  }

 private:
  std::vector<std::uint32_t> starts_;
};

}  // namespace roadbed::map::files
