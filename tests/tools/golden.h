#pragma once

#include <filesystem>
#include <string>

#include "roadbed/tests/support/real_data.h"

namespace roadbed::tests {

/// A file that the tests keep, by its folder and name: "info/two_roads.txt".
inline std::filesystem::path golden(const std::string& name) {
  return tests_folder() / "tools" / name;
}

}  // namespace roadbed::tests
