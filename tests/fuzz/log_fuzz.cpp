// MCAP or a bag's SQLite in; a drive, or InputError out.
#include <cstddef>
#include <cstdint>
#include <string>

#include "roadbed/map/files/input_error.h"
#include "roadbed/map/logs/log_drive.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  namespace map = roadbed::map;
  const std::string bytes(reinterpret_cast<const char*>(data), size);
  try {
    map::drive_of_log(
        [&](const map::LogVisitor& visitor) { map::parse_log(bytes, "fuzz.mcap", visitor); },
        "fuzz.mcap", "");
  } catch (const map::InputError&) {
  }
  return 0;
}
