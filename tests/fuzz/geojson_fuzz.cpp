// GeoJSON in: areas with their centrelines, or InputError out.
#include <cstddef>
#include <cstdint>
#include <string>

#include "roadbed/map/derived/surface.h"
#include "roadbed/map/files/input_error.h"
#include "roadbed/map/load_map.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string bytes(reinterpret_cast<const char*>(data), size);
  if (!bytes.starts_with('{')) return -1;  // other formats have targets of their own
  try {
    roadbed::map::road_centrelines(
        roadbed::map::parse_map(bytes, "fuzz.geojson", {.max_error_m = 0.1}));
  } catch (const roadbed::map::InputError&) {
  }
  return 0;
}
