#include "roadbed/tests/support/real_data.h"

#include <cstdlib>

namespace roadbed::tests {

std::filesystem::path real_data_folder() {
  const char* named = std::getenv("ROADBED_REAL_DATA");
  const std::filesystem::path folder = named != nullptr ? named : ROADBED_PROJECT "/../shared/real";
  return std::filesystem::is_directory(folder) ? folder : std::filesystem::path();
}

std::filesystem::path data_folder() { return ROADBED_PROJECT "/data"; }

std::filesystem::path tests_folder() { return ROADBED_PROJECT "/tests"; }

}  // namespace roadbed::tests
