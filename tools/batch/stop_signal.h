#pragma once

#include <csignal>

namespace roadbed::tools::inline batch {

/// While it lives, the first SIGINT or SIGTERM only asks to stop; the second of either ends the
/// process. A reader that has gone away is an error of writing, not the end of the process, and so
/// is a file that may not grow.
class StopSignal {
 public:
  StopSignal();
  ~StopSignal();
  StopSignal(const StopSignal&) = delete;
  StopSignal& operator=(const StopSignal&) = delete;

  static bool is_asked();

 private:
  struct sigaction interrupt_ {
  }, terminate_{}, pipe_{}, file_size_{};
};

}  // namespace roadbed::tools
