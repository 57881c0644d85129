#pragma once

#include <cstddef>
#include <functional>

namespace roadbed::tools {

/// Runs work(0) … work(count − 1), each in one of the threads, whichever is free. When one throws,
/// no other begins; what was thrown first is thrown on when those that run have ended.
void in_threads(std::size_t count, int threads, const std::function<void(std::size_t)>& work);

}  // namespace roadbed::tools
