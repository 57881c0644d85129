#include <cstddef>
#include <cstdint>
#include <string>

#include "roadbed/map/files/input_error.h"
#include "roadbed/map/load_map.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string bytes(reinterpret_cast<const char*>(data), size);
  const auto* format = roadbed::map::format_of(bytes);
  if (format == nullptr || format->name != "OpenDRIVE") return -1;  // not worth keeping
  try {
    // Coarse lines: what is read is the same, and what is made of it sooner done.
    roadbed::map::parse_map(bytes, "fuzz", {.max_error_m = 1.0});
  } catch (const roadbed::map::InputError&) {
    return 0;  // refused, as it should be
  }
  return 0;
}
