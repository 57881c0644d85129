// vehicle_info.param.yaml in, vehicle or InputError out.
#include <cstddef>
#include <cstdint>
#include <string>

#include "roadbed/map/files/input_error.h"
#include "roadbed/tools/files/vehicle_file.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string bytes(reinterpret_cast<const char*>(data), size);
  try {
    roadbed::tools::parse_vehicle(bytes, "fuzz.yaml").shape.check();
  } catch (const roadbed::map::InputError&) {
  }
  return 0;
}
