#pragma once

#include <pugixml.hpp>
#include <string>

#include "roadbed/map/repair/text_edits.h"

namespace roadbed::map::inline repair {

/// Where an element of a parsed document stands in the bytes that it was parsed from.
/// @throws InputError if it does not stand there, as in a file that is not in UTF-8.
XmlElementText text_of(const std::string& bytes, pugi::xml_node node);

}  // namespace roadbed::map::repair
