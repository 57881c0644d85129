// Text in, cloud or InputError out.
#include <cstddef>
#include <cstdint>
#include <string>

#include "roadbed/tests/fuzz/read_cloud.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string bytes(reinterpret_cast<const char*>(data), size);
  // By every second size it has to be told by its content.
  roadbed::tests::read_cloud(bytes, size % 2 == 0 ? "fuzz.xyz" : "fuzz");
  return 0;
}
