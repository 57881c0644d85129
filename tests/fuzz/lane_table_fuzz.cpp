// A table of lanes in, the mapping of its columns before the first zero byte: a map, or InputError
// out.
#include <cstddef>
#include <cstdint>
#include <string>

#include "roadbed/map/files/input_error.h"
#include "roadbed/map/lane_table/read.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace roadbed::map;
  const std::string bytes(reinterpret_cast<const char*>(data), size);
  const std::size_t end = bytes.find('\0');
  if (end == std::string::npos) return -1;
  try {
    const auto mapping = lane_table::read_mapping(bytes.substr(0, end), "columns.json");
    const RoadMap road_map(lane_table::read(bytes.substr(end + 1), "lanes", mapping));
  } catch (const InputError&) {
  }
  return 0;
}
