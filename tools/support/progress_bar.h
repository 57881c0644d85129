#pragma once

#include <cstddef>
#include <iosfwd>
#include <mutex>

namespace roadbed::tools {

/// A bar on a terminal that grows with every piece of work that is done; may be told so by several
/// threads.
class ProgressBar {
 public:
  /// @param is_shown  false: nothing is printed.
  ProgressBar(std::ostream& err, std::size_t all, bool is_shown)
      : err_(err), all_(all), is_shown_(is_shown) {}

  void done_one();

 private:
  std::ostream& err_;
  std::size_t all_, done_ = 0;
  bool is_shown_;
  std::mutex mutex_;
};

}  // namespace roadbed::tools
