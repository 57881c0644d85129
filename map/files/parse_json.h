#pragma once

#include <cstddef>
#include <nlohmann/json_fwd.hpp>
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

}  // namespace roadbed::map::files
