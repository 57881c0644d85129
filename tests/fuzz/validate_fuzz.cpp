// Any map file in, findings or InputError out.
#include <cstddef>
#include <cstdint>
#include <string>

#include "roadbed/map/files/input_error.h"
#include "roadbed/map/validate_file.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string bytes(reinterpret_cast<const char*>(data), size);
  try {
    roadbed::map::validate_bytes(bytes, "fuzz");
  } catch (const roadbed::map::InputError&) {
  }
  return 0;
}
