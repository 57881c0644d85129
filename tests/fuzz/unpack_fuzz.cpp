// gzip or Zstandard in, at most 50,000 bytes or InputError out; the start of the whole is what
// its first bytes are said to be.
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string>

#include "roadbed/map/files/input_error.h"
#include "roadbed/map/files/unpack.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string bytes(reinterpret_cast<const char*>(data), size);
  if (!roadbed::map::is_packed(bytes)) return 0;
  constexpr std::size_t most = 50'000;
  const std::string start = roadbed::map::unpacked_start(bytes, 100);
  try {
    const std::string whole = roadbed::map::unpacked(bytes, "fuzz.gz", most);
    if (whole.size() > most || start != whole.substr(0, 100)) std::abort();
  } catch (const roadbed::map::InputError&) {
  }
  return 0;
}
