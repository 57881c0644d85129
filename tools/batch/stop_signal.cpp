#include "roadbed/tools/batch/stop_signal.h"

#include <atomic>

namespace roadbed::tools::inline batch {
namespace {

std::atomic<bool> asked = false;  // a handler of signals has no other place
static_assert(std::atomic<bool>::is_always_lock_free);

void ask(int) {
  asked = true;
  std::signal(SIGINT, SIG_DFL);
  std::signal(SIGTERM, SIG_DFL);
}

}  // namespace

StopSignal::StopSignal() {
  asked = false;
  struct sigaction stop {};
  stop.sa_handler = ask;
  ::sigaction(SIGINT, &stop, &interrupt_);
  ::sigaction(SIGTERM, &stop, &terminate_);
  struct sigaction ignore {};
  ignore.sa_handler = SIG_IGN;
  ::sigaction(SIGPIPE, &ignore, &pipe_);
  ::sigaction(SIGXFSZ, &ignore, &file_size_);
}

StopSignal::~StopSignal() {
  ::sigaction(SIGINT, &interrupt_, nullptr);
  ::sigaction(SIGTERM, &terminate_, nullptr);
  ::sigaction(SIGPIPE, &pipe_, nullptr);
  ::sigaction(SIGXFSZ, &file_size_, nullptr);
}

bool StopSignal::is_asked() { return asked; }

}  // namespace roadbed::tools
