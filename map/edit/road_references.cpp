#include "roadbed/map/edit/road_references.h"

#include <algorithm>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "roadbed/map/edit/road_cut.h"
#include "roadbed/map/edit/xml_edit.h"

namespace roadbed::map::inline edit {
namespace {

struct Part {
  pugi::xml_node node;
  RoadCut cut;
  std::string id;
};

// The parts of every whole road that are there.
class Roads {
 public:
  explicit Roads(pugi::xml_node root) {
    for (const auto road : root.children("road")) {
      const RoadCut cut = road_cut(road);
      parts_[cut.road].push_back({road, cut, text(road, "id")});
    }
  }

  const std::map<std::string, std::vector<Part>>& all() const { return parts_; }

  bool has(const std::string& road) const { return parts_.contains(road); }

  // The part that has an end of the whole road.
  const Part* with_end(const std::string& road, bool start) const {
    return find(road, [&](const RoadCut& cut) { return start ? cut.has_start() : cut.has_end(); });
  }

  const Part* with_station(const std::string& road, double s_m) const {
    return find(road, [&](const RoadCut& cut) { return cut.from_m <= s_m && s_m <= cut.to_m; });
  }

  const Part* any(const std::string& road) const {
    return find(road, [](const RoadCut&) { return true; });
  }

 private:
  template <typename Fits>
  const Part* find(const std::string& road, const Fits& fits) const {
    const auto found = parts_.find(road);
    if (found == parts_.end()) return nullptr;
    const auto part = std::find_if(found->second.begin(), found->second.end(),
                                   [&](const Part& one) { return fits(one.cut); });
    return part == found->second.end() ? nullptr : &*part;
  }

  std::map<std::string, std::vector<Part>> parts_;
};

// A new element of the root behind those of its kind, or where they have to stand.
pugi::xml_node insert_in_root(pugi::xml_node root, pugi::xml_node like) {
  pugi::xml_node after;
  for (const char* before : {"header", "road", "controller", "junction"}) {
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

void restore_road(pugi::xml_node road) {
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
  const RoadCut cut = road_cut(road);
  restore_list(road, cut, "signals");
  restore_list(road, cut, "objects");
}

// What remembers nothing is taken out; so is the <cut> of a whole road.
void forget_empty(pugi::xml_node parent, bool is_road) {
  pugi::xml_node memory = find_clip_memory(parent);
  if (!memory) return;
  const auto cut = memory.child("cut");
  const bool is_whole = is_road && cut && road_cut(parent).is_whole();
  if (is_whole && text(parent, "id") == text(cut, "road")) memory.remove_child(cut);
  if (!memory.first_child()) parent.remove_child(memory);
}

class Settler {
 public:
  explicit Settler(pugi::xml_node root) : root_(root), roads_(root) {
    for (const auto& [id, parts] : roads_.all()) {
      for (const Part& part : parts) {
        for (const auto signal : part.node.child("signals").children("signal")) {
          signals_.insert(text(signal, "id"));
        }
        for (const auto object : part.node.child("objects").children("object")) {
          objects_.insert(text(object, "id"));
        }
      }
    }
  }

  SettledReferences run() {
    settle_all("controller", [&](pugi::xml_node one) { return settle_controller(one); });
    for (const auto one : root_.children("controller")) controllers_.insert(text(one, "id"));
    settle_all("junction", [&](pugi::xml_node one) { return settle_junction(one); });
    for (const auto one : root_.children("junction")) note_junction(one);
    for (const auto& [id, parts] : roads_.all()) {
      for (const Part& part : parts) settle_road(part);
    }
    forget_empty(root_, false);
    return settled_;
  }

 private:
  enum class Fate { same, changed, gone, forgotten };

  // Each element of a kind loses what is not there.
  template <typename Settle>
  void settle_all(const char* name, const Settle& settle) {
    for (const pugi::xml_node present : children(root_, name)) {
      const pugi::xml_node whole = root_.insert_copy_after(present, present);
      const Fate fate = settle(present);
      if (fate == Fate::changed || fate == Fate::gone) clip_memory(root_).append_copy(whole);
      root_.remove_child(whole);
      if (fate == Fate::gone || fate == Fate::forgotten) root_.remove_child(present);
    }
  }

  Fate settle_controller(pugi::xml_node controller) {
    std::size_t left = 0, gone = 0;
    for (const auto control : children(controller, "control")) {
      if (signals_.contains(text(control, "signalId"))) {
        ++left;
        continue;
      }
      controller.remove_child(control);
      ++gone;
    }
    if (gone == 0) return Fate::same;
    settled_.controls += left > 0 ? gone : 0;
    return left > 0 ? Fate::changed : Fate::forgotten;
  }

  Fate settle_junction(pugi::xml_node junction) {
    std::size_t left = 0, gone = 0;
    bool known = false, changed = false;
    for (const auto connection : children(junction, "connection")) {
      known = known || knows(connection);
      if (settle_connection(junction, connection, changed)) {
        ++left;
        continue;
      }
      junction.remove_child(connection);
      ++gone;
    }
    if (left == 0 && gone == 0) return Fate::same;  // it never had any
    if (left == 0) {
      settled_.junctions += known ? 1 : 0;
      return known ? Fate::gone : Fate::forgotten;
    }
    settled_.connections += gone;
    for (const auto priority : children(junction, "priority")) {
      if (roads_.has(text(priority, "high")) && roads_.has(text(priority, "low"))) continue;
      junction.remove_child(priority);
      ++gone;
    }
    for (const auto controller : children(junction, "controller")) {
      if (controllers_.contains(text(controller, "id"))) continue;
      junction.remove_child(controller);
      ++gone;
    }
    return gone > 0 || changed ? Fate::changed : Fate::same;
  }

  bool knows(pugi::xml_node connection) const {
    return roads_.has(text(connection, "incomingRoad")) ||
           roads_.has(text(connection, "connectingRoad")) ||
           roads_.has(text(connection, "linkedRoad"));
  }

  // Whether both ends that meet are there; then they are called as they are called now.
  bool settle_connection(pugi::xml_node junction, pugi::xml_node connection, bool& changed) const {
    const auto before = connection.child("predecessor"), behind = connection.child("successor");
    if (before && behind) {
      return settle_link(before, false, changed) && settle_link(behind, true, changed);
    }
    const char* other = connection.attribute("connectingRoad") ? "connectingRoad" : "linkedRoad";
    const bool at_start = text(connection, "contactPoint") != "end";
    const Part* connecting = roads_.with_end(text(connection, other), at_start);
    if (connecting == nullptr) return false;
    const Part* incoming = incoming_part(junction, connection, *connecting, at_start);
    if (incoming == nullptr) return false;
    rename(connection, other, connecting->id, changed);
    rename(connection, "incomingRoad", incoming->id, changed);
    return true;
  }

  static void rename(pugi::xml_node node, const char* attribute, const std::string& id,
                     bool& changed) {
    if (text(node, attribute) == id) return;
    set_text(node, attribute, id);
    changed = true;
  }

  // The end of the incoming road that the connecting one begins at: as that says, else as the
  // incoming road says.
  const Part* incoming_part(pugi::xml_node junction, pugi::xml_node connection,
                            const Part& connecting, bool at_start) const {
    const std::string road = text(connection, "incomingRoad");
    const auto link = connecting.node.child("link").child(at_start ? "predecessor" : "successor");
    if (text(link, "elementId") == road && text(link, "elementType") != "junction") {
      if (link.attribute("contactPoint")) {
        return roads_.with_end(road, text(link, "contactPoint") == "start");
      }
      if (link.attribute("elementS")) return roads_.with_station(road, number(link, "elementS"));
    }
    const Part* any = roads_.any(road);
    if (any == nullptr) return nullptr;
    const auto leads = [&](const char* end) {
      const auto one = any->node.child("link").child(end);
      return text(one, "elementType") == "junction" &&
             text(one, "elementId") == text(junction, "id");
    };
    if (leads("successor")) return roads_.with_end(road, false);
    if (leads("predecessor")) return roads_.with_end(road, true);
    return any;
  }

  void note_junction(pugi::xml_node junction) {
    const std::string id = text(junction, "id");
    junctions_.insert(id);
    for (const auto connection : junction.children("connection")) {
      for (const char* role : {"incomingRoad", "connectingRoad", "linkedRoad"}) {
        in_junction_.insert({id, text(connection, role)});
      }
    }
  }

  // A link of a whole road to what is there now.
  bool settle_link(pugi::xml_node link, bool is_successor, bool& changed) const {
    const std::string road = text(link, "elementId");
    if (link.attribute("elementS") && !link.attribute("contactPoint")) {
      const Part* part = roads_.with_station(road, number(link, "elementS"));
      if (part == nullptr) return false;
      rename(link, "elementId", part->id, changed);
      if (part->cut.from_m > 0.0) {
        set_number(link, "elementS", number(link, "elementS") - part->cut.from_m);
        changed = true;
      }
      return true;
    }
    const std::string contact = text(link, "contactPoint");
    const Part* part = roads_.with_end(road, contact.empty() ? is_successor : contact == "start");
    if (part == nullptr) return false;
    rename(link, "elementId", part->id, changed);
    return true;
  }

  bool settle_end(pugi::xml_node link, const Part& part, bool is_successor, bool& changed) const {
    if (is_successor ? !part.cut.has_end() : !part.cut.has_start()) return false;
    if (text(link, "elementType") != "junction") return settle_link(link, is_successor, changed);
    const std::string id = text(link, "elementId");
    return junctions_.contains(id) &&
           (in_junction_.contains({id, part.id}) || !was_named_by(id, part));
  }

  // Files link roads to junctions that do not name them; that is left as it is.
  bool was_named_by(const std::string& junction, const Part& part) const {
    const auto kept =
        find_clip_memory(root_).find_child_by_attribute("junction", "id", junction.c_str());
    for (const auto connection : kept.children("connection")) {
      for (const char* role : {"incomingRoad", "connectingRoad", "linkedRoad"}) {
        if (text(connection, role) == part.cut.road) return true;
      }
    }
    return false;
  }

  void settle_road(const Part& part) {
    settle_road_links(part);
    settle_membership(part);
    settle_references_of(part, "signals", "signalReference", signals_);
    settle_references_of(part, "objects", "objectReference", objects_);
    forget_empty(part.node, true);
  }

  void settle_road_links(const Part& part) {
    pugi::xml_node road = part.node, link = road.child("link");
    if (!link) return;
    const pugi::xml_node whole = road.insert_copy_after(link, link);
    bool changed = false;
    for (const bool is_successor : {false, true}) {
      const auto end = link.child(is_successor ? "successor" : "predecessor");
      if (!end || settle_end(end, part, is_successor, changed)) continue;
      const bool at_cut = is_successor ? !part.cut.has_end() : !part.cut.has_start();
      settled_.links += at_cut ? 0 : 1;
      link.remove_child(end);
      changed = true;
    }
    if (changed) clip_memory(road).append_copy(whole);
    road.remove_child(whole);
  }

  // A road of a junction of which no connection is left stands alone.
  void settle_membership(const Part& part) const {
    const std::string junction = text(part.node, "junction");
    if (junction.empty() || junction == "-1" || junctions_.contains(junction)) return;
    if (!find_clip_memory(root_).find_child_by_attribute("junction", "id", junction.c_str())) {
      return;  // the file never had it
    }
    set_text(clip_memory(part.node).append_child("in"), "junction", junction);
    set_text(part.node, "junction", "-1");
  }

  void settle_references_of(const Part& part, const char* list, const char* name,
                            const std::set<std::string>& targets) {
    pugi::xml_node road = part.node;
    for (const auto reference : children(road.child(list), name)) {
      if (targets.contains(text(reference, "id"))) continue;
      pugi::xml_node kept = child_of(clip_memory(road), list).append_copy(reference);
      if (part.cut.from_m > 0.0) set_number(kept, "s", number(kept, "s") + part.cut.from_m);
      road.child(list).remove_child(reference);
      ++settled_.references;
    }
  }

  pugi::xml_node root_;
  Roads roads_;
  std::set<std::string> signals_, objects_, controllers_, junctions_;
  std::set<std::pair<std::string, std::string>> in_junction_;  // junction, road as called now
  SettledReferences settled_;
};

}  // namespace

void restore_references(pugi::xml_node root) {
  for (const auto road : root.children("road")) restore_road(road);
  restore_in_root(root, "controller");
  restore_in_root(root, "junction");
  forget_empty(root, false);
}

SettledReferences settle_references(pugi::xml_node root) { return Settler(root).run(); }

}  // namespace roadbed::map::edit
