#pragma once

#include <cstddef>
#include <functional>

namespace roadbed::tools {

/// Runs work(0) … work(count − 1), each in one of the threads, whichever is free. `work` must not
/// throw.
void in_threads(std::size_t count, int threads, const std::function<void(std::size_t)>& work);

}  // namespace roadbed::tools
