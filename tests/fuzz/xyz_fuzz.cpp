// Text in, cloud or InputError out.
#include <cstddef>
#include <cstdint>
#include <string>

#include "roadbed/map/files/input_error.h"
#include "roadbed/map/occupancy/clouds/point_cloud.h"
#include "roadbed/map/occupancy/clouds/read_point_cloud.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string bytes(reinterpret_cast<const char*>(data), size);
  try {
    roadbed::map::parse_point_cloud(bytes, "fuzz.xyz");
  } catch (const roadbed::map::InputError&) {
  }
  return 0;
}
