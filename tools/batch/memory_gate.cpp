#include "roadbed/tools/batch/memory_gate.h"

#include <chrono>

namespace roadbed::tools::inline batch {

void MemoryGate::enter() {
  constexpr std::chrono::milliseconds pause{50};  // a running job may give some back before its end
  std::unique_lock lock(mutex_);
  while (running_ > 0 && resident_() > limit_) left_.wait_for(lock, pause);
  ++running_;
}

void MemoryGate::leave() {
  {
    const std::scoped_lock lock(mutex_);
    --running_;
  }
  left_.notify_one();
}

}  // namespace roadbed::tools
