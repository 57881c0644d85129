#include <cstddef>
#include <cstdint>
#include <string>

#include "roadbed/map/files/input_error.h"
#include "roadbed/map/lanelet2/write/autoware/write.h"
#include "roadbed/map/lanelet2/write/write.h"
#include "roadbed/map/load_map.h"

// What can be read can be written, too, and read again; done for every fourth size, as it takes
// ten times as long as reading.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace roadbed::map;
  try {
    const std::string bytes(reinterpret_cast<const char*>(data), size);
    const Format* format = format_of(bytes);
    if (format == nullptr || format->name != "Lanelet2") return -1;  // not worth keeping
    const RoadMap road_map = parse_map(bytes, "fuzz", {.max_error_m = 1.0});
    if (size % 4 == 0) {
      parse_map(
          lanelet2::write_lanelet2(road_map, {.crs = "EPSG:32632", .offset_in_crs = {}}).bytes,
          "written");
      parse_map(lanelet2::write_autoware(road_map, {road_map.crs(), {}, bytes}).vector_map,
                "for Autoware");
    }
  } catch (const InputError&) {
    return 0;  // refused, as it should be
  }
  return 0;
}
