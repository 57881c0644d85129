#pragma once

#include <cstddef>
#include <exception>
#include <functional>
#include <nlohmann/json_fwd.hpp>
#include <span>
#include <string>
#include <string_view>

namespace roadbed::map::inline files {

struct JsonRules {
  /// Refuses a key that stands twice in one object, as one of its values would be lost; otherwise
  /// the last one counts.
  bool keys_stand_once = true;
  std::size_t most_levels = 1'000'000;  ///< of lists and objects in each other
};

/// A JSON document. O(N log N) for N bytes.
/// @throws InputError where a rule is broken, or where its values would take more memory than a
///         document of its size may (geometry/primitives/work_limit.h).
/// @throws nlohmann::json::parse_error, out_of_range  where the text is no JSON, or has a number
///         that is too large.
nlohmann::json parse_json(std::string_view bytes, const std::string& file,
                          const JsonRules& rules = {});

/// Takes a part of a document: the keys that lead to it, and what it is.
using TakeJsonPart = std::function<void(std::span<const std::string> keys, nlohmann::json part)>;

/// Hands over a document part by part, so that only one is in memory at a time: in the file's
/// order whatever stands `level` objects deep, then the objects that it stands in, with null in its
/// place; of a list or value that stands less deep the whole.
/// Errors as of parse_json.
void parse_json_parts(std::string_view bytes, const std::string& file, const JsonRules& rules,
                      std::size_t level, const TakeJsonPart& take);

/// What the parsers throw over a text that is no JSON, as an error with the place.
/// @throws InputError always.
[[noreturn]] void refuse_json(const std::exception& error, const std::string& file);

}  // namespace roadbed::map::files
