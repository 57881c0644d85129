// Any map file in, findings or InputError out; by every rule that there is, but for some where the
// size is odd.
#include <cstddef>
#include <cstdint>
#include <string>

#include "roadbed/map/files/input_error.h"
#include "roadbed/map/validate_file.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using roadbed::map::validation::Severity;
  const std::string bytes(reinterpret_cast<const char*>(data), size);
  roadbed::map::validation::ValidateOptions options;
  options.max_error_m = 1.0;  // coarse lines are sooner judged
  options.choice.only = {"*"};
  if (size % 2 == 1) {
    options.choice.disabled = {"*.overlap", "1.?.0:*"};
    options.choice.severities = {{"Lane.*", Severity::info}, {"import.*", {}}};
  }
  try {
    roadbed::map::validate_bytes(bytes, "fuzz", options);
  } catch (const roadbed::map::InputError&) {
    return 0;  // refused, as it should be
  }
  return 0;
}
