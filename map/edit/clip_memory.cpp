#include "roadbed/map/edit/clip_memory.h"

#include "roadbed/map/edit/xml_edit.h"

namespace roadbed::map::inline edit {

pugi::xml_node find_clip_memory(pugi::xml_node parent) {
  return parent.find_child_by_attribute("userData", "code", "roadbed.clip");
}

pugi::xml_node clip_memory(pugi::xml_node parent) {
  if (const pugi::xml_node found = find_clip_memory(parent)) return found;
  pugi::xml_node made = parent.append_child("userData");
  set_text(made, "code", "roadbed.clip");
  return made;
}

void remove_empty_memory(pugi::xml_node parent) {
  const pugi::xml_node memory = find_clip_memory(parent);
  if (memory && !memory.first_child()) parent.remove_child(memory);
}

}  // namespace roadbed::map::edit
