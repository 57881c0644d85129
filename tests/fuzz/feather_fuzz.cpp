// Feather in, columns of an ego's poses and of annotations or InputError out.
#include <cstddef>
#include <cstdint>
#include <string>

#include "roadbed/map/files/input_error.h"
#include "roadbed/map/logs/feather.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string bytes(reinterpret_cast<const char*>(data), size);
  try {
    roadbed::map::parse_feather(bytes, "fuzz.feather", {"timestamp_ns", "tx_m", "qw"});
    roadbed::map::parse_feather(bytes, "fuzz.feather", {"timestamp_ns"}, {"track_uuid"});
  } catch (const roadbed::map::InputError&) {
  }
  return 0;
}
