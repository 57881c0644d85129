#include "roadbed/map/files/line_starts.h"

#include <algorithm>

namespace roadbed::map::inline files {

LineStarts::LineStarts(std::string_view text) : starts_{0} {
  for (auto end = text.find('\n'); end != text.npos; end = text.find('\n', end + 1)) {
    starts_.push_back(static_cast<std::uint32_t>(end + 1));
  }
}

long LineStarts::line_at(std::size_t offset) const {
  return static_cast<long>(std::upper_bound(starts_.begin(), starts_.end(), offset) -
                           starts_.begin());
}

}  // namespace roadbed::map::files
