#include "roadbed/tests/support/sha256sum.h"

#include <cstdio>
#include <stdexcept>

#include "roadbed/tests/support/program_run.h"

namespace roadbed::tests {

std::string sha256sum_of(const std::filesystem::path& file) {
  constexpr std::size_t kDigits = 64;
  std::FILE* const pipe = ::popen(("sha256sum < '" + file.string() + "'").c_str(), "r");
  std::string digits(kDigits, '\0');
  const bool is_read = pipe != nullptr && std::fread(digits.data(), 1, kDigits, pipe) == kDigits;
  if (pipe != nullptr) ::pclose(pipe);
  if (!is_read) throw std::runtime_error("sha256sum failed on " + file.string());
  return digits;
}

std::string sha256sum_of_bytes(std::string_view bytes) {
  const TemporaryFolder folder;
  return sha256sum_of(folder.write("bytes", bytes));
}

}  // namespace roadbed::tests
