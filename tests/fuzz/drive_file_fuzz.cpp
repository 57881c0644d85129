// Lines of poses, a CommonRoad solution or Feather in; a drive, or InputError out. Whose poses they
// are, their size says.
#include <cstddef>
#include <cstdint>
#include <string>

#include "roadbed/map/files/input_error.h"
#include "roadbed/tools/files/drive_file.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string bytes(reinterpret_cast<const char*>(data), size);
  using roadbed::tools::PoseFrame;
  roadbed::tools::DriveOptions options;
  if (size % 8 != 0) options.rate_hz = 10.0;
  if (size % 4 != 0) options.pose_frame = PoseFrame{{1.0, 0.0, 0.1}, size % 4 == 1};
  try {
    roadbed::tools::parse_drive(bytes, "fuzz.txt", options);
  } catch (const roadbed::map::InputError&) {
  }
  return 0;
}
