#pragma once

#include <condition_variable>
#include <cstdint>
#include <functional>
#include <mutex>

namespace roadbed::tools::inline batch {

/// Lets jobs start one after the other while memory is short: none starts while the resident memory
/// is above the limit and another one runs. So one always runs, however much it takes.
class MemoryGate {
 public:
  /// @param resident  bytes that are taken now; may be asked by several threads.
  MemoryGate(std::uint64_t limit, std::function<std::uint64_t()> resident)
      : limit_(limit), resident_(std::move(resident)) {}

  /// One job; waits to be let in, and leaves in the end.
  class Pass {
   public:
    explicit Pass(MemoryGate& gate) : gate_(gate) { gate_.enter(); }
    ~Pass() { gate_.leave(); }
    Pass(const Pass&) = delete;
    Pass& operator=(const Pass&) = delete;

   private:
    MemoryGate& gate_;
  };

 private:
  void enter();
  void leave();

  std::uint64_t limit_;
  std::function<std::uint64_t()> resident_;
  std::mutex mutex_;
  std::condition_variable left_;
  int running_ = 0;
};

}  // namespace roadbed::tools
