// An Argoverse 2 map in: a map, or InputError out.
#include <cstddef>
#include <cstdint>
#include <string>

#include "roadbed/map/argoverse/read.h"
#include "roadbed/map/files/input_error.h"
#include "roadbed/map/load_map.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string bytes(reinterpret_cast<const char*>(data), size);
  if (!roadbed::map::argoverse::is_argoverse(bytes)) return -1;  // others have their own targets
  try {
    roadbed::map::parse_map(bytes, "fuzz.json", {.max_error_m = 0.1});
  } catch (const roadbed::map::InputError&) {
  }
  return 0;
}
