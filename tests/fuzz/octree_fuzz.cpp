// OctoMap .bt or .ot in, octree or InputError out.
#include <cstddef>
#include <cstdint>
#include <string>

#include "roadbed/map/files/input_error.h"
#include "roadbed/map/occupancy/octree/occupancy_map.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string bytes(reinterpret_cast<const char*>(data), size);
  try {
    roadbed::map::OccupancyMap::parse(bytes, "fuzz.bt");
  } catch (const roadbed::map::InputError&) {
  }
  return 0;
}
