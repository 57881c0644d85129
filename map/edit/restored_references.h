#pragma once

#include <pugixml.hpp>

namespace roadbed::map::inline edit {

/// Puts back what the clip memories of a file hold, as it was in the whole map; it may lead to what
/// is not there.
/// @param root  `<OpenDRIVE>`.
void restore_references(pugi::xml_node root);

}  // namespace roadbed::map::edit
