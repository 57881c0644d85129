#pragma once

#include <cstddef>
#include <functional>
#include <memory>

namespace roadbed::map::inline files {

/// How many processors there are for this process, one at least.
int processors();

/// Runs work(0) … work(count − 1), each in one of the threads, whichever is free. When one throws,
/// no other begins; when those that run have ended, what the least of them threw is thrown on. So
/// results and errors are the same for any number of threads.
void in_threads(std::size_t count, int threads, const std::function<void(std::size_t)>& work);

/// Runs work(from, to) on runs of indices that together are 0 … count − 1, in the same way: for
/// many small pieces of work.
void in_threads_by_runs(std::size_t count, int threads,
                        const std::function<void(std::size_t from, std::size_t to)>& work);

/// The same where each thread makes its work before the first that it does.
void in_threads_that_make(std::size_t count, int threads,
                          const std::function<std::function<void(std::size_t)>()>& make_work);

/// Runs work(own, 0) … work(own, count − 1) in the same way: `own` is what `make` made for the
/// thread.
template <typename Make, typename Work>
void in_threads(std::size_t count, int threads, const Make& make, const Work& work) {
  in_threads_that_make(count, threads, [&]() -> std::function<void(std::size_t)> {
    // Shared, as a std::function can be copied and what a thread has for itself need not.
    const auto own = std::make_shared<decltype(make())>(make());
    return [own, &work](std::size_t i) { work(*own, i); };
  });
}

}  // namespace roadbed::map::files
