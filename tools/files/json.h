#pragma once

#include <nlohmann/json.hpp>

namespace roadbed::tools::inline files {

/// JSON as it is written: keys in the order in which they were given.
using Json = nlohmann::ordered_json;

}  // namespace roadbed::tools
