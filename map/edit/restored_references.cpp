#include "roadbed/map/edit/restored_references.h"

#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "roadbed/map/edit/lane_links.h"
#include "roadbed/map/edit/road_cut.h"
#include "roadbed/map/edit/xml_edit.h"

namespace roadbed::map::inline edit {
namespace {

// A new element of the root behind those of its kind, or where they have to stand.
pugi::xml_node insert_in_root(pugi::xml_node root, pugi::xml_node like) {
  pugi::xml_node after;
  for (const char* before :
       {"header", "road", "controller", "junction", "junctionGroup", "station"}) {
    for (const auto node : root.children(before)) after = node;
    if (std::string_view(before) == like.name()) break;
  }
  return after ? root.insert_copy_after(like, after) : root.append_copy(like);
}

void restore_in_root(pugi::xml_node root, const char* name) {
  const std::vector<pugi::xml_node> all = children(find_clip_memory(root), name);
  if (all.empty()) return;
  std::map<std::string, pugi::xml_node> by_id;
  for (const auto one : root.children(name)) by_id.emplace(text(one, "id"), one);
  for (const auto kept : all) {
    const auto found = by_id.find(text(kept, "id"));
    const pugi::xml_node present = found == by_id.end() ? pugi::xml_node() : found->second;
    if (present) {
      root.insert_copy_before(kept, present);
      root.remove_child(present);
    } else {
      insert_in_root(root, kept);
    }
    find_clip_memory(root).remove_child(kept);
  }
}

// Kept references have stations of the whole road.
void restore_list(pugi::xml_node road, const RoadCut& cut, const char* list) {
  pugi::xml_node kept = find_clip_memory(road).child(list);
  for (const auto reference : kept.children()) {
    const double s_m = number(reference, "s");
    if (s_m < cut.from_m || s_m > cut.to_m) continue;
    pugi::xml_node back = ordered_child(road, list, kRoadOrder).append_copy(reference);
    if (cut.from_m > 0.0) set_number(back, "s", s_m - cut.from_m);
  }
  if (kept) find_clip_memory(road).remove_child(kept);
}

void restore_position(pugi::xml_node signal) {
  pugi::xml_node memory = find_clip_memory(signal);
  const pugi::xml_node kept = memory.child("positionRoad");
  if (!kept) return;
  signal.remove_child("positionRoad");
  signal.insert_copy_before(kept, memory);
  memory.remove_child(kept);
  remove_empty_memory(signal);
}

void restore_road(pugi::xml_node road) {
  const RoadCut cut = road_cut(road);
  if (cut.has_start()) restore_lane_links(end_section(road, false), "predecessor");
  if (cut.has_end()) restore_lane_links(end_section(road, true), "successor");
  for (const auto signal : road.child("signals").children("signal")) restore_position(signal);
  pugi::xml_node memory = find_clip_memory(road);
  if (!memory) return;
  if (const auto kept = memory.child("link")) {
    road.remove_child("link");
    road.prepend_copy(kept);
    memory.remove_child(kept);
  }
  if (const auto in = memory.child("in")) {
    set_text(road, "junction", text(in, "junction"));
    memory.remove_child(in);
  }
  for (const char* list : {"railroad", "surface"}) {
    if (const auto kept = memory.child(list)) {
      road.remove_child(list);
      insert_ordered(road, kept, kRoadOrder);
      memory.remove_child(kept);
    }
  }
  restore_list(road, cut, "signals");
  restore_list(road, cut, "objects");
}

}  // namespace

void restore_references(pugi::xml_node root) {
  for (const auto road : root.children("road")) restore_road(road);
  for (const char* kind : {"controller", "junction", "junctionGroup", "station"}) {
    restore_in_root(root, kind);
  }
  forget_empty_memory(root);
}

}  // namespace roadbed::map::edit
