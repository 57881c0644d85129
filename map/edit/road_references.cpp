#include "roadbed/map/edit/road_references.h"

#include <algorithm>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "roadbed/map/edit/lane_links.h"
#include "roadbed/map/edit/named_roads.h"
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

  // The part that has most of a stretch; none that has only its end.
  const Part* with_stretch(const std::string& road, double from_m, double to_m) const {
    if (from_m == to_m) return with_station(road, from_m);
    const Part* best = nullptr;
    double most_m = 0.0;
    const auto found = parts_.find(road);
    if (found == parts_.end()) return nullptr;
    for (const Part& part : found->second) {
      const double shared_m = std::min(part.cut.to_m, to_m) - std::max(part.cut.from_m, from_m);
      if (shared_m > most_m) best = &part, most_m = shared_m;
    }
    return best;
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
    settle_all("junctionGroup", [&](pugi::xml_node one) { return settle_group(one); });
    settle_all("station", [&](pugi::xml_node one) { return settle_station(one); });
    for (const auto& [id, parts] : roads_.all()) {
      for (const Part& part : parts) settle_road(part);
    }
    forget_empty_memory(root_);
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

  struct Kept {
    std::size_t left = 0, gone = 0;
  };

  // Takes those children off that do not stay.
  template <typename Stays>
  static Kept keep(pugi::xml_node parent, const char* name, const Stays& stays) {
    Kept kept;
    for (const auto child : children(parent, name)) {
      if (stays(child)) {
        ++kept.left;
      } else {
        parent.remove_child(child);
        ++kept.gone;
      }
    }
    return kept;
  }

  Fate settle_controller(pugi::xml_node controller) {
    const Kept controls = keep(controller, "control", [&](pugi::xml_node one) {
      return signals_.contains(text(one, "signalId"));
    });
    settled_.controls += controls.left > 0 ? controls.gone : 0;
    return fate(controls, controls.gone > 0, false);
  }

  // A junction stands on connections, or on two sections of roads that cross, and a virtual one on
  // its main road.
  Fate settle_junction(pugi::xml_node junction) {
    const bool known = knows(junction);
    bool changed = false;
    const Kept connections = keep(junction, "connection", [&](pugi::xml_node one) {
      return settle_connection(junction, one, changed);
    });
    const auto is_there = [&](pugi::xml_node one) { return settle_names(one, false, changed); };
    const auto is_whole = [&](pugi::xml_node one) { return settle_names(one, true, changed); };
    const Kept sections = keep(junction, "roadSection", is_there);
    const bool stands = connections.left > 0 || sections.left > 1 ||
                        connections.gone + sections.gone == 0;  // it never had any
    if (!stands || !is_there(junction)) {
      settled_.junctions += known ? 1 : 0;
      return known ? Fate::gone : Fate::forgotten;
    }
    settled_.connections += connections.gone;
    const std::size_t others =
        keep(junction, "priority", is_there).gone + keep(junction, "crossPath", is_whole).gone +
        keep(junction, "boundary",
             [&](pugi::xml_node one) { return keep(one, "segment", is_whole).gone == 0; })
            .gone +
        keep(junction, "controller", [&](pugi::xml_node one) {
          return controllers_.contains(text(one, "id"));
        }).gone;
    changed = changed || connections.gone + sections.gone + others > 0;
    return changed ? Fate::changed : Fate::same;
  }

  Fate settle_group(pugi::xml_node group) const {
    bool known = false;
    const Kept junctions = keep(group, "junctionReference", [&](pugi::xml_node one) {
      const std::string id = text(one, "junction");
      const bool is_there = junctions_.contains(id);
      known = known || is_there ||
              find_clip_memory(root_).find_child_by_attribute("junction", "id", id.c_str());
      return is_there;
    });
    return fate(junctions, junctions.gone > 0, known);
  }

  Fate settle_station(pugi::xml_node station) const {
    const bool known = knows(station);
    bool changed = false;
    const Kept platforms = keep(station, "platform", [&](pugi::xml_node platform) {
      const Kept segments = keep(platform, "segment", [&](pugi::xml_node one) {
        return settle_names(one, false, changed);
      });
      changed = changed || segments.gone > 0;
      return segments.left > 0 || segments.gone == 0;
    });
    return fate(platforms, changed, known);
  }

  static Fate fate(const Kept& parts, bool changed, bool known) {
    if (parts.left == 0 && parts.gone > 0) return known ? Fate::gone : Fate::forgotten;
    return changed ? Fate::changed : Fate::same;
  }

  // Whether an element names a road of which anything is there.
  bool knows(pugi::xml_node element) const {
    bool known = false;
    for_each_named_road(element,
                        [&](const NamedRoad& named) { known = known || roads_.has(named.road()); });
    return known;
  }

  // A station of a whole road, or what the words of a boundary's segment stand for.
  static double station_m(const std::pair<pugi::xml_node, const char*>& station,
                          const RoadCut& cut) {
    const std::string written = text(station.first, station.second);
    const double s_m = written == "end" ? cut.length_m : number(station.first, station.second);
    return std::clamp(s_m, 0.0, cut.length_m);
  }

  // Whether the roads that an element names are there, where it names them; then they are called as
  // they are called now, and stations count from where they begin now.
  // @param whole  a stretch has to be there from end to end; else it is shortened.
  bool settle_names(pugi::xml_node element, bool whole, bool& changed) const {
    for (const NamedRoad& named : named_roads(element)) {
      const Part* part = part_of(named);
      if (part == nullptr) return false;
      rename(named.node, named.attribute, part->id, changed);
      if (part->cut.is_whole()) continue;
      for (const auto& station : named.stations) {
        const double s_m = station_m(station, part->cut);
        const double kept_m = std::clamp(s_m, part->cut.from_m, part->cut.to_m);
        if (whole && kept_m != s_m) return false;
        if (kept_m == s_m && (part->cut.has_start() || is_word(station))) continue;
        set_number(station.first, station.second, kept_m - part->cut.from_m);
        changed = true;
      }
    }
    return true;
  }

  static bool is_word(const std::pair<pugi::xml_node, const char*>& station) {
    const std::string written = text(station.first, station.second);
    return written == "start" || written == "end";
  }

  const Part* part_of(const NamedRoad& named) const {
    const std::string road = named.road();
    const std::string contact = text(named.node, "contactPoint");
    const Part* any = roads_.any(road);
    if (any == nullptr) return nullptr;
    if (named.stations.empty()) {
      return contact.empty() ? any : roads_.with_end(road, contact == "start");
    }
    const double first_m = station_m(named.stations.front(), any->cut);
    const double last_m = station_m(named.stations.back(), any->cut);
    return roads_.with_stretch(road, std::min(first_m, last_m), std::max(first_m, last_m));
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
    settle_positions(part);
    settle_railroad(part);
    settle_surface(part);
    settle_references_of(part, "signals", "signalReference", signals_);
    settle_references_of(part, "objects", "objectReference", objects_);
    forget_empty_memory(part.node);
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
      if (!at_cut) {  // where the cut is, they went with it
        ++settled_.links;
        take_lane_links(end_section(road, is_successor), end.name(), true);
      }
      link.remove_child(end);
      changed = true;
    }
    if (changed) clip_memory(road).append_copy(whole);
    road.remove_child(whole);
  }

  void settle_positions(const Part& part) const {
    for (auto signal : part.node.child("signals").children("signal")) {
      const pugi::xml_node position = signal.child("positionRoad");
      if (!position) continue;
      const pugi::xml_node whole = signal.insert_copy_after(position, position);
      bool changed = false;
      const bool is_there = settle_names(position, false, changed);
      if (changed || !is_there) clip_memory(signal).append_copy(whole);
      if (!is_there) signal.remove_child(position);
      signal.remove_child(whole);
    }
  }

  // Of a road that is there in parts each had the same list, of which `settle` leaves what is its.
  template <typename Settle>
  static void settle_list(const Part& part, const char* name, const Settle& settle) {
    pugi::xml_node road = part.node;
    const pugi::xml_node list = road.child(name);
    if (!list) return;
    const pugi::xml_node whole = road.insert_copy_after(list, list);
    if (settle(list)) clip_memory(road).append_copy(whole);
    road.remove_child(whole);
  }

  // A switch is on the part that has its place on the main track.
  void settle_railroad(const Part& part) const {
    settle_list(part, "railroad", [&](pugi::xml_node railroad) {
      bool changed = false;
      const Kept kept = keep(railroad, "switch", [&](pugi::xml_node one) {
        const bool own = text(one.child("mainTrack"), "id") == part.cut.road;
        return settle_names(one.child("mainTrack"), false, changed) &&
               settle_names(one.child("sideTrack"), false, changed) &&
               (!own || text(one.child("mainTrack"), "id") == part.id);
      });
      return changed || kept.gone > 0;
    });
  }

  // The grid goes on from where it began: its start is now behind the road's.
  void settle_surface(const Part& part) const {
    if (part.cut.is_whole()) return;
    settle_list(part, "surface", [&](pugi::xml_node surface) {
      keep(surface, "CRG", [&](pugi::xml_node grid) {
        const double from_m = number(grid, "sStart"), to_m = number(grid, "sEnd");
        const double begin_m = std::max(from_m, part.cut.from_m);
        const double end_m = std::min(to_m, part.cut.to_m);
        if (begin_m >= end_m) return false;
        if (begin_m > from_m && text(grid, "mode") != "global") {
          set_number(grid, "sOffset", number(grid, "sOffset") - (begin_m - from_m));
        }
        set_number(grid, "sStart", begin_m - part.cut.from_m);
        set_number(grid, "sEnd", end_m - part.cut.from_m);
        return true;
      });
      return true;
    });
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

SettledReferences settle_references(pugi::xml_node root) { return Settler(root).run(); }

}  // namespace roadbed::map::edit
