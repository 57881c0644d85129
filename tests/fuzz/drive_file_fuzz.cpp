// Lines of poses, a CommonRoad solution or Feather in; a drive, or InputError out.
#include <cstddef>
#include <cstdint>
#include <string>

#include "roadbed/map/files/input_error.h"
#include "roadbed/tools/files/drive_file.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string bytes(reinterpret_cast<const char*>(data), size);
  try {
    roadbed::tools::parse_drive(
        bytes, "fuzz.txt",
        {.topic = "", .pose_frame = roadbed::tools::PoseFrame{{1.0, 0.0, 0.1}}, .rate_hz = 10.0});
  } catch (const roadbed::map::InputError&) {
  }
  return 0;
}
