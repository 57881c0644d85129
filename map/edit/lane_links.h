#pragma once

#include <functional>
#include <pugixml.hpp>

namespace roadbed::map::inline edit {

/// The lanes of a `<laneSection>`, from left to right.
void for_each_lane(pugi::xml_node section, const std::function<void(pugi::xml_node)>& f);

/// The first or the last `<laneSection>` of a road by its station; none where it has none.
pugi::xml_node end_section(pugi::xml_node road, bool is_last);

/// Takes the links off that lanes have over one end of their section.
/// @param end  "predecessor" or "successor".
/// @param remembered  whether they go to the clip memories of their lanes; else what those have for
///                    that end is gone, too.
void take_lane_links(pugi::xml_node section, const char* end, bool remembered);

/// Gives lanes the links back that their clip memories have for that end.
void restore_lane_links(pugi::xml_node section, const char* end);

}  // namespace roadbed::map::edit
