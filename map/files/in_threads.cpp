#include "roadbed/map/files/in_threads.h"

#include <sched.h>

#include <algorithm>
#include <atomic>
#include <exception>
#include <mutex>
#include <system_error>
#include <thread>
#include <vector>

namespace roadbed::map::inline files {
namespace {

/// What the threads share. Indices are taken in their order, so that all below one that throws have
/// been taken too, and are done or throw themselves.
class Indices {
 public:
  explicit Indices(std::size_t count) : count_(count), failed_at_(count) {}

  /// The next one; count or more if there is none.
  std::size_t take() { return next_++; }

  void fail_at(std::size_t index, const std::exception_ptr& error) {
    next_ = count_;  // what has not begun does not
    const std::scoped_lock lock(mutex_);
    if (index >= failed_at_) return;
    failed_at_ = index;
    error_ = error;
  }

  void rethrow() const {
    if (error_) std::rethrow_exception(error_);
  }

 private:
  std::size_t count_;
  std::atomic<std::size_t> next_ = 0;
  std::mutex mutex_;  // of all that follows
  std::size_t failed_at_;
  std::exception_ptr error_;
};

}  // namespace

int processors() {
  cpu_set_t ours;
  if (::sched_getaffinity(0, sizeof ours, &ours) == 0) return std::max(1, CPU_COUNT(&ours));
  return static_cast<int>(std::max(1U, std::thread::hardware_concurrency()));
}

void in_threads_that_make(std::size_t count, int threads,
                          const std::function<std::function<void(std::size_t)>()>& make_work) {
  Indices indices(count);
  const auto run = [&] {
    std::size_t i = indices.take();
    if (i >= count) return;
    try {
      const auto work = make_work();
      for (; i < count; i = indices.take()) work(i);
    } catch (...) {
      indices.fail_at(i, std::current_exception());
    }
  };
  const auto others = std::min(count, static_cast<std::size_t>(std::max(1, threads))) - (count > 0);
  {
    std::vector<std::jthread> running;
    try {
      for (std::size_t i = 0; i < others; ++i) running.emplace_back(run);
    } catch (const std::system_error&) {
      // The system gives no more of them; those that run do all of it.
    }
    run();
  }
  indices.rethrow();
}

void in_threads_by_runs(std::size_t count, int threads,
                        const std::function<void(std::size_t, std::size_t)>& work) {
  constexpr std::size_t kRun = 1024;
  in_threads((count + kRun - 1) / kRun, threads,
             [&](std::size_t run) { work(run * kRun, std::min(count, (run + 1) * kRun)); });
}

void in_threads(std::size_t count, int threads, const std::function<void(std::size_t)>& work) {
  in_threads_that_make(count, threads, [&] { return work; });
}

}  // namespace roadbed::map::files
