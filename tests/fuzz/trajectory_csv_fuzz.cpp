// trajectory.csv in, drive or InputError out.
#include <cstddef>
#include <cstdint>
#include <string>

#include "roadbed/map/files/input_error.h"
#include "roadbed/tools/files/trajectory_csv.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string bytes(reinterpret_cast<const char*>(data), size);
  try {
    roadbed::tools::parse_trajectory_csv(bytes, "fuzz.csv");
  } catch (const roadbed::map::InputError&) {
  }
  return 0;
}
