#include <cstddef>
#include <cstdint>
#include <string>

#include "roadbed/map/files/input_error.h"
#include "roadbed/map/load_map.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  try {
    // Coarse lines: what is read is the same, and what is made of it sooner done.
    roadbed::map::parse_map(std::string(reinterpret_cast<const char*>(data), size), "fuzz",
                            {.max_error_m = 1.0});
  } catch (const roadbed::map::InputError&) {
    return 0;  // refused, as it should be
  }
  return 0;
}
