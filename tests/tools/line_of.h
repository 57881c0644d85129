#pragma once

#include <fmt/format.h>

#include <string>
#include <vector>

namespace roadbed::tests {

/// Words as one types them.
inline std::string line_of(const std::vector<std::string>& words) {
  return fmt::format("{}", fmt::join(words, " "));
}

}  // namespace roadbed::tests
