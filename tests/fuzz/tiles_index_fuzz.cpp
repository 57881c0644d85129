// The index of a tiled occupancy in, index or InputError out.
#include <cstddef>
#include <cstdint>
#include <string_view>

#include "roadbed/map/files/input_error.h"
#include "roadbed/map/occupancy/octree/tiles_index.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view bytes(reinterpret_cast<const char*>(data), size);
  try {
    roadbed::map::parse_tiles_index(bytes, "index.json");
  } catch (const roadbed::map::InputError&) {
  }
  return 0;
}
