// An Argoverse 2 map in: a map, or InputError out. Behind a # the heights of the
// ground: the transform, a zero, the raster.
#include <cstddef>
#include <cstdint>
#include <string>

#include "roadbed/map/argoverse/ground_height.h"
#include "roadbed/map/argoverse/read.h"
#include "roadbed/map/files/input_error.h"
#include "roadbed/map/load_map.h"

namespace {

void read_ground(const std::string& bytes) {
  using roadbed::map::argoverse::GroundHeight;
  const std::size_t end = bytes.find('\0', 1);
  if (end == std::string::npos) return;
  try {
    const auto ground = GroundHeight::parse({"transform.json", bytes.substr(1, end - 1)},
                                            {"raster.npy", bytes.substr(end + 1)});
    for (const double at_m : {0.0, 1.5, -3.0, 1e9}) ground.at_m({at_m, at_m});
  } catch (const roadbed::map::InputError&) {
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string bytes(reinterpret_cast<const char*>(data), size);
  if (bytes.starts_with('#')) {
    read_ground(bytes);
    return 0;
  }
  if (!roadbed::map::argoverse::is_argoverse(bytes)) return -1;  // others have their own targets
  try {
    roadbed::map::parse_map(bytes, "fuzz.json", {.max_error_m = 0.1});
  } catch (const roadbed::map::InputError&) {
  }
  return 0;
}
