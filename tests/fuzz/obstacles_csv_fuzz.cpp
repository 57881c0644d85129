#include <cstddef>
#include <cstdint>
#include <string_view>

#include "roadbed/map/files/input_error.h"
#include "roadbed/tools/files/obstacles_csv.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view bytes(reinterpret_cast<const char*>(data), size);
  try {
    roadbed::tools::parse_obstacles_csv(bytes, "fuzz.csv");
  } catch (const roadbed::map::InputError&) {
  }
  return 0;
}
