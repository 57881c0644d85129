#include <cstddef>
#include <cstdint>
#include <string_view>

#include "roadbed/map/files/input_error.h"
#include "roadbed/tools/files/points_csv.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  try {
    roadbed::tools::parse_point_table({reinterpret_cast<const char*>(data), size}, "fuzz.csv");
  } catch (const roadbed::map::InputError&) {
    return 0;  // refused, as it should be
  }
  return 0;
}
