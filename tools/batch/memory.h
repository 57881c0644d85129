#pragma once

#include <sys/types.h>

#include <condition_variable>
#include <cstdint>
#include <functional>
#include <mutex>
#include <optional>
#include <string>
#include <string_view>

namespace roadbed::tools::inline batch {

/// "4GB", "4G", "512 MB", "65536": bytes, in powers of 1000. None if it is no such text, or 0.
std::optional<std::uint64_t> parse_memory_size(std::string_view text);

/// "2 GB", "1.5 MB": of parse_memory_size's units.
std::string memory_size_text(std::uint64_t bytes);

/// Memory of a process [bytes]; 0 if there is none.
struct ProcessMemory {
  std::uint64_t reserved = 0, resident = 0;
};
ProcessMemory memory_of_process(pid_t process);

/// Lets this process reserve so much more than it has now; what goes beyond throws std::bad_alloc.
void limit_memory(std::uint64_t bytes);

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

}  // namespace roadbed::tools::batch
