#pragma once

#include <string>
#include <utility>
#include <vector>

namespace roadbed::map::inline elements {

/// What a source says of a thing beyond what the model has words for: key and value as they stand
/// there, in the source's order.
using Attributes = std::vector<std::pair<std::string, std::string>>;

}  // namespace roadbed::map::elements
