// LAS in, cloud or InputError out.
#include <cstddef>
#include <cstdint>
#include <string>

#include "roadbed/tests/fuzz/read_cloud.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string bytes(reinterpret_cast<const char*>(data), size);
  if (!bytes.starts_with("LASF")) return -1;  // others have their own targets
  roadbed::tests::read_cloud(bytes, "fuzz.las");
  return 0;
}
