#pragma once

#include <string>
#include <string_view>

namespace roadbed::tests {

/// Whether a text has a part. Not testing::HasSubstr, which would print the whole text.
inline bool holds(const std::string& text, std::string_view part) {
  return text.find(part) != std::string::npos;
}

}  // namespace roadbed::tests
