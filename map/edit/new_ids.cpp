#include "roadbed/map/edit/new_ids.h"

#include <algorithm>
#include <charconv>
#include <vector>

#include "roadbed/map/edit/road_cut.h"
#include "roadbed/map/edit/xml_edit.h"

namespace roadbed::map::inline edit {
namespace {

void rename(pugi::xml_node node, const char* attribute, const NameChanges& names) {
  const auto found = names.find(text(node, attribute));
  if (found != names.end()) set_text(node, attribute, found->second);
}

}  // namespace

std::optional<std::int64_t> number_of(const std::string& id) {
  std::int64_t value = 0;
  const auto [end, error] = std::from_chars(id.data(), id.data() + id.size(), value);
  return error == std::errc() && end == id.data() + id.size() ? std::optional(value) : std::nullopt;
}

void FreshIds::take(const std::string& id) {
  const std::int64_t value = number_of(id).value_or(0);
  if (value >= next_ && value < INT64_MAX) next_ = value + 1;
}

std::string FreshIds::fresh() {
  const std::string id = std::to_string(next_);
  take(id);
  return id;
}

void NewIds::apply(pugi::xml_node root) const {
  for (const auto road : root.children("road")) apply_to_road(road);
  for (const auto controller : root.children("controller")) {
    rename(controller, "id", controllers);
    for (const auto control : controller.children("control")) {
      rename(control, "signalId", signals);
    }
  }
  for (const auto junction : root.children("junction")) apply_to_junction(junction);
}

void NewIds::apply_to_road(pugi::xml_node road) const {
  rename(find_clip_memory(road).child("cut"), "road", roads);
  rename(road, "id", roads);
  rename(road, "junction", junctions);
  for (const auto end : road.child("link").children()) {
    rename(end, "elementId", text(end, "elementType") == "junction" ? junctions : roads);
  }
  for (const auto signal : road.child("signals").children()) {
    rename(signal, "id", signals);
    for (const auto other : signal.children("dependency")) rename(other, "id", signals);
  }
  for (const auto object : road.child("objects").children()) rename(object, "id", objects);
}

void NewIds::apply_to_junction(pugi::xml_node junction) const {
  rename(junction, "id", junctions);
  rename(junction, "mainRoad", roads);
  for (const auto controller : junction.children("controller")) {
    rename(controller, "id", controllers);
  }
  for (const auto priority : junction.children("priority")) {
    rename(priority, "high", roads);
    rename(priority, "low", roads);
  }
  for (const auto connection : junction.children("connection")) {
    for (const char* role : {"incomingRoad", "connectingRoad", "linkedRoad"}) {
      rename(connection, role, roads);
    }
    for (const auto end : connection.children()) rename(end, "elementId", roads);
  }
}

bool is_in_order(pugi::xml_node root, const char* kind) {
  std::int64_t before = INT64_MIN;
  for (const auto one : root.children(kind)) {
    const auto number = number_of(text(one, "id"));
    if (!number || *number < before) return false;
    before = *number;
  }
  return true;
}

void put_in_order(pugi::xml_node root, const char* kind) {
  std::vector<pugi::xml_node> all = children(root, kind);
  if (all.empty()) return;
  std::stable_sort(all.begin(), all.end(), [](pugi::xml_node a, pugi::xml_node b) {
    return number_of(text(a, "id")) < number_of(text(b, "id"));
  });
  root.insert_move_before(all.front(), root.child(kind));
  for (std::size_t i = 1; i < all.size(); ++i) root.insert_move_after(all[i], all[i - 1]);
}

}  // namespace roadbed::map::edit
