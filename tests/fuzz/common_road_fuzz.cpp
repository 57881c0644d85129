// CommonRoad in: map, scenario and the map written again, or InputError out.
#include <cstddef>
#include <cstdint>
#include <string>

#include "roadbed/map/commonroad/scenario.h"
#include "roadbed/map/commonroad/write.h"
#include "roadbed/map/files/input_error.h"
#include "roadbed/map/load_map.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string bytes(reinterpret_cast<const char*>(data), size);
  const auto* format = roadbed::map::format_of(bytes);
  if (format == nullptr || format->name != "CommonRoad") return -1;  // not worth keeping
  try {
    roadbed::map::commonroad::parse_scenario(bytes, "fuzz.xml");
  } catch (const roadbed::map::InputError&) {
  }
  try {
    roadbed::map::commonroad::write_common_road(
        roadbed::map::parse_map(bytes, "fuzz.xml", {.max_error_m = 1.0}));
  } catch (const roadbed::map::InputError&) {
  }
  return 0;
}
