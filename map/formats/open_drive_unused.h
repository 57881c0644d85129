#pragma once

#include "roadbed/map/formats/open_drive_document.h"

namespace roadbed::map::open_drive {

/// Counts elements that the reader does not look at, by "parent/element"; what stands inside one
/// belongs to it. In order of name.
std::vector<UnusedContent> count_unused(const XmlDocument& xml);

}  // namespace roadbed::map::open_drive
