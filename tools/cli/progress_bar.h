#pragma once

#include <chrono>
#include <cstddef>
#include <mutex>
#include <string>

namespace roadbed::tools::inline cli {

/// A bar on a terminal that grows with every piece of work that is done, and says how long the rest
/// will take at the pace so far; may be told so by several threads.
class ProgressBar {
 public:
  /// On standard error as it is, past what makes texts visible there: a bar begins its line anew.
  /// @param is_shown  false: nothing is printed.
  ProgressBar(std::size_t all, bool is_shown) : all_(all), is_shown_(is_shown) {}

  void done_one();

  /// One more is done that took no work, and says nothing of the pace.
  void skip_one();

 private:
  using Clock = std::chrono::steady_clock;

  void draw();
  std::string time_left(Clock::time_point now) const;

  std::size_t all_, done_ = 0, skipped_ = 0;
  bool is_shown_;
  Clock::time_point start_ = Clock::now(), drawn_ = {};
  std::mutex mutex_;
};

/// "45 s", "3 min", "2.5 h".
std::string duration_text(double seconds);

}  // namespace roadbed::tools::cli
