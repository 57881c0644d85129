#include "roadbed/tools/cli/progress_bar.h"

#include <fmt/format.h>

#include <cstdio>

namespace roadbed::tools::inline cli {

void ProgressBar::done_one() {
  const std::scoped_lock lock(mutex_);
  ++done_;
  draw();
}

void ProgressBar::skip_one() {
  const std::scoped_lock lock(mutex_);
  ++done_;
  ++skipped_;
  draw();
}

void ProgressBar::draw() {
  if (!is_shown_ || done_ > all_) return;  // more came than were counted
  constexpr std::size_t width = 40;
  constexpr std::chrono::milliseconds pause{50};  // a terminal is slower than many a piece of work
  const auto now = Clock::now();
  const bool is_last = done_ == all_;
  if (!is_last && now - drawn_ < pause) return;
  drawn_ = now;
  const std::size_t full = width * done_ / all_;
  fmt::print(stderr, "\r[{:#<{}}{:.<{}}] {}/{}{:<14}{}", "", full, "", width - full, done_, all_,
             is_last ? "" : time_left(now), is_last ? "\n" : "");
}

std::string ProgressBar::time_left(Clock::time_point now) const {
  const std::size_t worked = done_ - skipped_;
  if (worked == 0) return "";
  const double pace_s =
      std::chrono::duration<double>(now - start_).count() / static_cast<double>(worked);
  return ", " + duration_text(pace_s * static_cast<double>(all_ - done_)) + " left";
}

std::string duration_text(double seconds) {
  constexpr double minute_s = 60.0, hour_s = 3600.0;
  if (seconds < 2.0 * minute_s) return fmt::format("{:.0f} s", seconds);
  if (seconds < 2.0 * hour_s) return fmt::format("{:.0f} min", seconds / minute_s);
  return fmt::format("{:.1f} h", seconds / hour_s);
}

}  // namespace roadbed::tools::cli
