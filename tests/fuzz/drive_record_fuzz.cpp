#include <cstddef>
#include <cstdint>
#include <string_view>

#include "roadbed/map/files/input_error.h"
#include "roadbed/tools/report/drive_record.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  try {
    roadbed::tools::parse_drive_record({reinterpret_cast<const char*>(data), size},
                                       "fuzz/replay.json");
  } catch (const roadbed::map::InputError&) {
  }
  return 0;
}
