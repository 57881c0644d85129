#pragma once

#include <string>
#include <string_view>

namespace roadbed::tools::inline batch {

/// A JSON document without the blanks between its parts, so on one line; all else stays as it is
/// written, numbers too.
/// @pre `json` is valid.
std::string compact_json(std::string_view json);

}  // namespace roadbed::tools
