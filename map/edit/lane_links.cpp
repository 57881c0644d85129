#include "roadbed/map/edit/lane_links.h"

#include "roadbed/map/edit/clip_memory.h"
#include "roadbed/map/edit/xml_edit.h"

namespace roadbed::map::inline edit {
void for_each_lane(pugi::xml_node section, const std::function<void(pugi::xml_node)>& f) {
  for (const char* side : {"left", "center", "right"}) {
    for (const auto lane : section.child(side).children("lane")) f(lane);
  }
}

pugi::xml_node end_section(pugi::xml_node road, bool is_last) {
  pugi::xml_node end;
  for (const auto section : road.child("lanes").children("laneSection")) {
    const double s_m = number(section, "s");
    if (!end || (is_last ? s_m >= number(end, "s") : s_m < number(end, "s"))) end = section;
  }
  return end;
}

void take_lane_links(pugi::xml_node section, const char* end, bool remembered) {
  for_each_lane(section, [&](pugi::xml_node lane) {
    const pugi::xml_node links = lane.child("link");
    if (remembered) {
      for (const auto link : links.children(end)) clip_memory(lane).append_copy(link);
    } else {
      remove_children(find_clip_memory(lane), end);
    }
    remove_children(links, end);
    remove_empty_memory(lane);
  });
}

void restore_lane_links(pugi::xml_node section, const char* end) {
  for_each_lane(section, [&](pugi::xml_node lane) {
    const pugi::xml_node memory = find_clip_memory(lane);
    for (const auto link : memory.children(end)) {
      ordered_child(lane, "link", kLaneOrder).append_copy(link);
    }
    remove_children(memory, end);
    remove_empty_memory(lane);
  });
}

}  // namespace roadbed::map::edit
