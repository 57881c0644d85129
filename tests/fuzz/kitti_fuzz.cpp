// A scan of KITTI or, by the first byte, of nuScenes in, cloud or InputError out.
#include <cstddef>
#include <cstdint>
#include <string>

#include "roadbed/tests/fuzz/read_cloud.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size == 0) return -1;
  const std::string bytes(reinterpret_cast<const char*>(data + 1), size - 1);
  roadbed::tests::read_cloud(bytes, data[0] % 2 == 1 ? "fuzz.pcd.bin" : "fuzz.bin");
  return 0;
}
