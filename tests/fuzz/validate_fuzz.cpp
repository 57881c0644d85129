// Any map file in, findings or InputError out; by the rules that are usual or, by every second
// size, by Autoware's.
#include <cstddef>
#include <cstdint>
#include <string>

#include "roadbed/map/files/input_error.h"
#include "roadbed/map/validate_file.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using roadbed::map::validation::Profile;
  const std::string bytes(reinterpret_cast<const char*>(data), size);
  roadbed::map::validation::ValidateOptions options;
  options.max_error_m = 1.0;  // coarse lines are sooner judged
  options.choice.profile = size % 2 == 0 ? Profile::planning : Profile::autoware;
  try {
    roadbed::map::validate_bytes(bytes, "fuzz", options);
  } catch (const roadbed::map::InputError&) {
    return 0;  // refused, as it should be
  }
  return 0;
}
