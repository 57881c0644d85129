#include "roadbed/map/edit/new_ids.h"

#include <algorithm>
#include <charconv>
#include <string_view>
#include <vector>

#include "roadbed/map/edit/named_roads.h"
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
  for (const auto element : root.children()) apply_to(element);
}

void NewIds::apply_to(pugi::xml_node element) const {
  const std::string_view kind = element.name();
  if (kind == "road") apply_to_road(element);
  if (kind == "junction") rename(element, "id", junctions);
  if (kind == "junctionGroup") rename(element, "id", groups);
  if (kind == "station") rename(element, "id", stations);
  if (kind == "controller") rename(element, "id", controllers);
  for (const auto control : element.children("control")) rename(control, "signalId", signals);
  for (const auto controller : element.children("controller")) {
    rename(controller, "id", controllers);
  }
  for (const auto reference : element.children("junctionReference")) {
    rename(reference, "junction", junctions);
  }
  for_each_named_road(element,
                      [&](const NamedRoad& named) { rename(named.node, named.attribute, roads); });
}

void NewIds::apply_to_road(pugi::xml_node road) const {
  rename(find_clip_memory(road).child("cut"), "road", roads);
  rename(road, "id", roads);
  rename(road, "junction", junctions);
  for (const auto end : road.child("link").children()) {
    if (text(end, "elementType") == "junction") rename(end, "elementId", junctions);
  }
  for (const auto signal : road.child("signals").children()) {
    rename(signal, "id", signals);
    for (const auto other : signal.children("dependency")) rename(other, "id", signals);
    for (const auto other : signal.children("reference")) {
      rename(other, "elementId", text(other, "elementType") == "object" ? objects : signals);
    }
  }
  for (const auto object : road.child("objects").children()) rename(object, "id", objects);
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
