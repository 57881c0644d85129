#pragma once

#include <pugixml.hpp>

namespace roadbed::map::inline edit {

/// Where a road, a lane or the root keeps what a clip took from it, made where it is missing:
/// `<userData code="roadbed.clip">`.
pugi::xml_node clip_memory(pugi::xml_node parent);
pugi::xml_node find_clip_memory(pugi::xml_node parent);

/// Takes it out where it holds nothing.
void remove_empty_memory(pugi::xml_node parent);

}  // namespace roadbed::map::edit
