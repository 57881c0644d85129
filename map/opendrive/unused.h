#pragma once

#include "roadbed/map/opendrive/document.h"

namespace roadbed::map::opendrive {

/// Counts elements that the reader does not look at, by "parent/element"; what stands inside one
/// belongs to it. In order of name.
std::vector<UnusedContent> count_unused(const XmlDocument& xml);

}  // namespace roadbed::map::opendrive
