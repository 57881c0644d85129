#include <xxhash.h>

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <string>

#include "roadbed/map/compiled_map.h"
#include "roadbed/map/input_error.h"

// The payload is given a right header and checksum, so that what is fuzzed is the reader behind.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  std::string bytes = "roadbed map v001";
  const std::uint64_t hash = XXH3_64bits(data, size), length = size;
  bytes.append(reinterpret_cast<const char*>(&length), sizeof length);
  bytes.append(reinterpret_cast<const char*>(&hash), sizeof hash);
  bytes.append(reinterpret_cast<const char*>(data), size);
  try {
    roadbed::map::read_compiled_map(bytes, "fuzz");
  } catch (const roadbed::map::InputError&) {
    return 0;  // refused, as it should be
  }
  return 0;
}
