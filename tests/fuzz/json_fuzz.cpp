// Bytes in, a JSON document or InputError out: just what another parser takes, but for keys that
// stand twice. Part by part it is the same; any value can be asked for what it may be.
#include <array>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <nlohmann/json.hpp>
#include <span>
#include <string>
#include <string_view>

#include "roadbed/map/files/input_error.h"
#include "roadbed/map/files/json_text.h"
#include "roadbed/map/files/parse_json.h"
#include "roadbed/tools/files/json.h"

namespace {

using namespace roadbed;
using nlohmann::json;

template <typename Ask>
void guarded(const Ask& ask) {
  try {
    ask();
  } catch (const map::InputError&) {
    return;  // refused, as it should be
  }
}

// One question for each value, the next for the next: those that are refused take long.
void ask(const tools::JsonNode& node, std::size_t& number) {
  static constexpr std::array questions{
      +[](const tools::JsonNode& of) {
        of.number({-1.0, 1e3});
      },
      +[](const tools::JsonNode& of) {
        of.number_or("a", 0.0, {0.0, 9.0});
      },
      +[](const tools::JsonNode& of) { of.boolean(); },
      +[](const tools::JsonNode& of) { of.name(); },
      +[](const tools::JsonNode& of) { of.one_line(); },
      +[](const tools::JsonNode& of) { of.at("a"); },
      +[](const tools::JsonNode& of) { of.check_version("job"); },
      +[](const tools::JsonNode& of) { of.check_version("noise", 2); },
      +[](const tools::JsonNode& of) {
        of.require_object({"a", "roadbed_job"});
      },
      +[](const tools::JsonNode& of) { of.members(); },
      +[](const tools::JsonNode& of) { of.elements(); },
  };
  guarded([&] { questions[number++ % questions.size()](node); });
  if (node.value().is_object()) {
    for (const auto& [key, member] : node.members()) ask(member, number);
  } else if (node.value().is_array()) {
    for (const tools::JsonNode& element : node.elements()) ask(element, number);
  }
}

void read_in_parts(std::string_view bytes, const json& whole) {
  json together;
  map::parse_json_parts(bytes, "fuzz.json", {}, 1,
                        [&](std::span<const std::string> keys, json part) {
                          if (keys.empty()) {
                            if (part.is_object() && together.is_object()) part.update(together);
                            together = std::move(part);
                          } else {
                            together[keys.front()] = std::move(part);
                          }
                        });
  if (together != whole) std::abort();
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view bytes(reinterpret_cast<const char*>(data), size);
  const json plain = json::parse(bytes, nullptr, false);
  guarded([&] {
    const json strict = tools::parse_json_strictly(bytes, "fuzz.json");
    if (plain.is_discarded() || plain != strict) std::abort();
    if (json::parse(map::json_text(strict)) != strict) std::abort();
    read_in_parts(bytes, strict);
  });
  guarded([&] {
    try {
      const json document =
          map::parse_json(bytes, "fuzz.json", {.keys_stand_once = false, .most_levels = 100});
      std::size_t number = size;
      ask({document, "fuzz.json"}, number);
    } catch (const json::exception& error) {
      map::refuse_json(error, "fuzz.json");
    }
  });
  return 0;
}
