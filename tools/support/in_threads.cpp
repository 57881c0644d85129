#include "roadbed/tools/support/in_threads.h"

#include <algorithm>
#include <atomic>
#include <exception>
#include <mutex>
#include <thread>
#include <vector>

namespace roadbed::tools {

void in_threads(std::size_t count, int threads, const std::function<void(std::size_t)>& work) {
  std::atomic<std::size_t> next = 0;
  std::mutex mutex;
  std::exception_ptr error;
  const auto run = [&] {
    try {
      for (std::size_t i = next++; i < count; i = next++) work(i);
    } catch (...) {
      next = count;  // what has not begun does not
      const std::scoped_lock lock(mutex);
      if (!error) error = std::current_exception();
    }
  };
  const auto others = std::min(count, static_cast<std::size_t>(std::max(1, threads))) - (count > 0);
  {
    std::vector<std::jthread> running;
    for (std::size_t i = 0; i < others; ++i) running.emplace_back(run);
    run();
  }
  if (error) std::rethrow_exception(error);
}

}  // namespace roadbed::tools
