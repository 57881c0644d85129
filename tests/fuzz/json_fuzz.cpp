// Bytes in, a JSON document or InputError out: just what another parser takes, but for keys that
// stand twice.
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>

#include "roadbed/map/files/input_error.h"
#include "roadbed/map/files/json_text.h"
#include "roadbed/tools/files/json.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace roadbed;
  const std::string_view bytes(reinterpret_cast<const char*>(data), size);
  const auto plain = nlohmann::json::parse(bytes, nullptr, false);
  try {
    const nlohmann::json strict = tools::parse_json_strictly(bytes, "fuzz.json");
    if (plain.is_discarded() || plain != strict) std::abort();
    if (nlohmann::json::parse(map::json_text(strict)) != strict) std::abort();
  } catch (const map::InputError&) {
    return 0;  // refused, as it should be
  }
  return 0;
}
