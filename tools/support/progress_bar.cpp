#include "roadbed/tools/support/progress_bar.h"

#include <fmt/ostream.h>

#include <ostream>

namespace roadbed::tools {

void ProgressBar::done_one() {
  const std::scoped_lock lock(mutex_);
  ++done_;
  if (!is_shown_) return;
  constexpr std::size_t width = 40;
  const std::size_t full = width * done_ / all_;
  fmt::print(err_, "\r[{:#<{}}{:.<{}}] {}/{}{}", "", full, "", width - full, done_, all_,
             done_ == all_ ? "\n" : "");
  err_.flush();
}

}  // namespace roadbed::tools
