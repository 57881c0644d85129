#pragma once

#include <string>

#include "roadbed/map/files/visible_text.h"

namespace roadbed::map::inline files {

/// A JSON document as it is written or printed, one line or indented: bytes of its texts that are
/// no UTF-8 become U+FFFD, and what is hidden (`is_hidden`) is written as `\u202e`.
/// @tparam Json  nlohmann::json or nlohmann::ordered_json.
template <typename Json>
std::string json_text(const Json& json, int indent = -1) {
  return visible_text(json.dump(indent, ' ', false, Json::error_handler_t::replace));
}

}  // namespace roadbed::map::files
