#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <set>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "roadbed/geometry/primitives/disjoint_sets.h"
#include "roadbed/map/edit/merging/coordinate_systems.h"
#include "roadbed/map/edit/merging/link_ends.h"
#include "roadbed/map/edit/merging/merge.h"
#include "roadbed/map/edit/merging/road_join.h"
#include "roadbed/map/edit/new_ids.h"
#include "roadbed/map/edit/plan_cut.h"
#include "roadbed/map/edit/restored_references.h"
#include "roadbed/map/edit/road_cut.h"
#include "roadbed/map/edit/road_references.h"
#include "roadbed/map/edit/xml_edit.h"
#include "roadbed/map/opendrive/read.h"

namespace roadbed::map::inline edit::inline merging {
namespace {

bool is_clip_memory(pugi::xml_node node) { return text(node, "code") == "roadbed.clip"; }

bool are_equal(pugi::xml_node a, pugi::xml_node b) { return say_the_same(a, b, is_clip_memory); }

/// A file whose elements are merged.
struct Source {
  XmlDocument xml;
  CoordinateSystem system;
  std::string name;

  pugi::xml_node root() const { return xml.root(); }
};

Source read_source(MergeInput input) {
  XmlDocument xml(std::move(input.bytes), input.name);
  opendrive::Document document = opendrive::read_document(xml);
  if (document.refusal) throw *document.refusal;
  const auto& offset = document.offset_in_crs;
  return {std::move(xml), {document.crs, {offset.x_m, offset.y_m, offset.heading_rad}}, input.name};
}

/// A kind of elements of the root that have ids. What names others stands behind those.
struct IdKind {
  const char* name;
  NameChanges NewIds::*names;
};
constexpr std::array<IdKind, 5> kKinds = {{{"road", &NewIds::roads},
                                           {"controller", &NewIds::controllers},
                                           {"junction", &NewIds::junctions},
                                           {"junctionGroup", &NewIds::groups},
                                           {"station", &NewIds::stations}}};
using OfKinds = std::array<bool, kKinds.size()>;

/// Whether the elements of each kind stand in order of their numbers.
OfKinds kinds_in_order(pugi::xml_node root) {
  OfKinds in_order{};
  for (std::size_t i = 0; i < kKinds.size(); ++i) in_order[i] = is_in_order(root, kKinds[i].name);
  return in_order;
}

/// What of a road's list has an id of its own: signals; objects, bridges and tunnels.
std::vector<pugi::xml_node> named_in(pugi::xml_node road, const char* list) {
  std::vector<pugi::xml_node> named;
  for (const auto one : road.child(list).children()) {
    const std::string_view name = one.name();
    if (one.attribute("id") && !name.ends_with("Reference")) named.push_back(one);
  }
  return named;
}

/// Nothing names a bridge or a tunnel: two of one id in one map stay as they are.
bool can_be_referred_to(pugi::xml_node one) {
  const std::string_view name = one.name();
  return name != "bridge" && name != "tunnel";
}

class Merger {
 public:
  Merger(pugi::xml_node root, std::size_t files, const MergeOptions& options)
      : root_(root), options_(options), in_order_(kinds_in_order(root)), maps_(files) {
    for (const auto road : root.children("road")) note_road(road);
    for (std::size_t i = 1; i < kKinds.size(); ++i) {
      for (const auto one : root.children(kKinds[i].name)) {
        by_id_[i].emplace(text(one, "id"), one);
        last_[i] = one;
      }
    }
    for (const auto one : root.children()) {
      if (is_other(one)) others_[one.name()].push_back(one);
    }
  }

  void add(const Source& source, Merged& result) {
    const OfKinds in_order = kinds_in_order(source.root());
    for (std::size_t i = 0; i < in_order.size(); ++i) in_order_[i] = in_order_[i] && in_order[i];
    const NewIds names = new_names(source, result);
    names.apply(source.root());
    for (const auto road : source.root().children("road")) add_road(road);
    for (std::size_t i = 1; i < kKinds.size(); ++i) {
      for (const auto one : source.root().children(kKinds[i].name)) add_once(i, one);
    }
    add_others(source.root());
    widen_header(source.root().child("header"));
  }

  void finish(const std::string& file, Merged& result) {
    name_parts(file, result);
    for (std::size_t i = 0; i < kKinds.size(); ++i) {
      if (in_order_[i]) put_in_order(root_, kKinds[i].name);
    }
    const SettledReferences settled = settle_references(root_);
    result.count("roads taken once that several maps hold", repeated_);
    result.count("roads put together of parts", joined_.size());
    result.count("parts of roads whose neighbouring part is missing", open_parts_);
    result.count("road links that lead nowhere", settled.links);
    result.count("connections of junctions that lead nowhere", settled.connections);
    result.seams.insert(result.seams.end(), seams_.begin(), seams_.end());
    link_coinciding_ends(root_, origins_, options_.tolerance_m, result.seams);
    const auto linked =
        std::count_if(result.seams.begin(), result.seams.end(),
                      [](const Seam& seam) { return seam.what.starts_with("linked"); });
    result.count("ends of roads linked", static_cast<std::size_t>(linked));
  }

 private:
  using ById = std::map<std::string, pugi::xml_node>;

  // Ids of what is in a list of roads.
  struct TakenIds {
    const char* list;
    NameChanges NewIds::*names;
    std::map<std::string, std::set<std::string>> roads = {};  // whole ones: files repeat ids
    FreshIds ids = {};
  };

  void note_road(pugi::xml_node road) {
    last_[0] = road;
    parts_[road_cut(road).road].push_back(road);
    note_ids(road);
  }

  // Roads, signals and whatever else has the id of something that is not the same.
  NewIds new_names(const Source& source, Merged& result) {
    ++source_;
    NewIds names;
    FreshIds roads;
    for (const auto& [id, parts] : parts_) roads.take(id);
    std::set<std::string> same;
    for (const auto road : source.root().children("road")) roads.take(road_cut(road).road);
    std::map<std::string, std::size_t> of_id;  // roads before
    for (const auto road : source.root().children("road")) {
      const std::string id = road_cut(road).road;
      if (!parts_.contains(id) || names.roads.contains(id)) continue;
      if (is_same_road(id, road, of_id[id]++)) {
        same.insert(id);
      } else {
        give(source, "road", id, roads, names.roads, result);
      }
    }
    for (const std::string& id : same) maps_.join(source_, source_of(id));
    for (TakenIds& taken : inside_) name_inside(source, same, taken, names, result);
    for (std::size_t i = 1; i < kKinds.size(); ++i) name_others(source, i, result, names);
    return names;
  }

  static void give(const Source& source, const char* kind, const std::string& id, FreshIds& ids,
                   NameChanges& to, Merged& result) {
    to[id] = ids.fresh();
    result.renamed.push_back({source.name, kind, id, to[id]});
  }

  void name_inside(const Source& source, const std::set<std::string>& same, TakenIds& taken,
                   NewIds& names, Merged& result) {
    NameChanges& to = names.*taken.names;
    for (const auto road : source.root().children("road")) {
      for (const auto one : named_in(road, taken.list)) taken.ids.take(text(one, "id"));
    }
    for (const auto road : source.root().children("road")) {
      const std::string road_id = road_cut(road).road;
      for (const auto one : named_in(road, taken.list)) {
        const std::string id = text(one, "id");
        const auto found = taken.roads.find(id);
        if (found == taken.roads.end() || to.contains(id)) continue;
        if (same.contains(road_id) && found->second.contains(road_id)) continue;
        if (!can_be_referred_to(one) && are_of_this_map(found->second)) continue;
        give(source, one.name(), id, taken.ids, to, result);
      }
    }
  }

  std::size_t source_of(const std::string& road) {
    return origins_[text(parts_[road].front(), "id")];
  }

  bool are_of_this_map(const std::set<std::string>& roads) {
    return std::all_of(roads.begin(), roads.end(), [&](const std::string& road) {
      return maps_.of(source_of(road)) == maps_.of(source_);
    });
  }

  // What names something renamed is another thing, too.
  void name_others(const Source& source, std::size_t kind, Merged& result, NewIds& names) const {
    const auto all = source.root().children(kKinds[kind].name);
    NameChanges& to = names.*kKinds[kind].names;
    FreshIds ids;
    for (const auto& [id, one] : by_id_[kind]) ids.take(id);
    for (const auto one : all) ids.take(text(one, "id"));
    for (const auto one : all) {
      const std::string id = text(one, "id");
      const auto found = by_id_[kind].find(id);
      if (found == by_id_[kind].end()) continue;
      if (are_equal(found->second, one) && !leads_to_renamed(one, names)) continue;
      give(source, kKinds[kind].name, id, ids, to, result);
    }
  }

  static bool leads_to_renamed(pugi::xml_node one, const NewIds& names) {
    pugi::xml_document renamed;
    names.apply_to(renamed.append_copy(one));
    return !are_equal(one, renamed.first_child());
  }

  // Whether a road is one that is there already, or a part of the same. Of very many with one id
  // those are looked at that stand in the same place among them.
  bool is_same_road(const std::string& id, pugi::xml_node road, std::size_t place) const {
    constexpr std::size_t most = 64;
    const std::vector<pugi::xml_node>& parts = parts_.at(id);
    const std::size_t first = parts.size() > most ? std::min(place, parts.size() - most) : 0;
    const std::span<const pugi::xml_node> near(&parts[first], std::min(most, parts.size()));
    const RoadCut cut = road_cut(road);
    return std::any_of(near.begin(), near.end(), [&](pugi::xml_node part) {
      const RoadCut own = road_cut(part);
      if (std::abs(own.length_m - cut.length_m) > 1e-6) return false;
      if (own.is_whole() && cut.is_whole()) {
        return are_equal(part.child("planView"), road.child("planView")) &&
               are_equal(part.child("lanes"), road.child("lanes"));
      }
      const double from_m = std::max(own.from_m, cut.from_m), to_m = std::min(own.to_m, cut.to_m);
      if (from_m > to_m) return !own.is_whole() && !cut.is_whole();
      const auto there = reference_pose(part, from_m - own.from_m).position();
      return (there - reference_pose(road, from_m - cut.from_m).position()).norm() < 1e-3;
    });
  }

  void add_road(pugi::xml_node road) {
    std::vector<pugi::xml_node>& parts = parts_[road_cut(road).road];
    const RoadCut cut = road_cut(road);
    const bool is_there = std::any_of(parts.begin(), parts.end(), [&](pugi::xml_node part) {
      const RoadCut own = road_cut(part);
      return own.from_m <= cut.from_m && cut.to_m <= own.to_m;
    });
    if (is_there) {
      ++repeated_;
      return;
    }
    last_[0] = root_.insert_copy_after(road, last_[0]);
    parts.push_back(last_[0]);
    note_ids(last_[0]);
    join(parts);
  }

  void note_ids(pugi::xml_node road) {
    const std::string id = road_cut(road).road;
    origins_[text(road, "id")] = source_;
    for (TakenIds& taken : inside_) {
      for (const auto one : named_in(road, taken.list)) {
        taken.roads[text(one, "id")].insert(id);
        taken.ids.take(text(one, "id"));
      }
    }
  }

  // Parts in order of their stations; each is put to the one before that it goes on from.
  void join(std::vector<pugi::xml_node>& parts) {
    std::stable_sort(parts.begin(), parts.end(), [](pugi::xml_node a, pugi::xml_node b) {
      return road_cut(a).from_m < road_cut(b).from_m;
    });
    for (std::size_t i = 0; i + 1 < parts.size();) {
      if (!goes_on(parts[i], parts[i + 1])) {
        ++i;
        continue;
      }
      const RoadCut second = road_cut(parts[i + 1]), first = road_cut(parts[i]);
      const double at_m = std::min(first.to_m, second.from_m);
      const auto there = reference_pose(parts[i], at_m - first.from_m).position();
      const auto here = reference_pose(parts[i + 1], at_m - second.from_m).position();
      seams_.push_back({fmt::format("road {} up to {:.3f} m", first.road, first.to_m),
                        fmt::format("road {} from {:.3f} m", first.road, second.from_m),
                        (there - here).norm(), "joined", here.x(), here.y()});
      join_roads(parts[i], parts[i + 1]);
      if (parts[i + 1] == last_[0]) last_[0] = last_[0].previous_sibling();
      root_.remove_child(parts[i + 1]);
      parts.erase(parts.begin() + static_cast<std::ptrdiff_t>(i) + 1);
      joined_.insert(first.road);
    }
  }

  void add_once(std::size_t kind, pugi::xml_node one) {
    if (by_id_[kind].contains(text(one, "id"))) return;
    std::size_t behind = kind;  // or the nearest kind before it
    while (behind > 0 && !last_[behind]) --behind;
    last_[kind] = root_.insert_copy_after(one, last_[behind]);
    by_id_[kind].emplace(text(one, "id"), last_[kind]);
  }

  static bool is_other(pugi::xml_node one) {
    const std::string_view name = one.name();
    return one.type() == pugi::node_element && name != "header" && !is_clip_memory(one) &&
           std::none_of(kKinds.begin(), kKinds.end(), [&](auto kind) { return name == kind.name; });
  }

  // Whatever else is in the root, once.
  void add_others(pugi::xml_node root) {
    for (const auto one : root.children()) {
      if (!is_other(one)) continue;
      std::vector<pugi::xml_node>& own = others_[one.name()];
      if (std::none_of(own.begin(), own.end(), [&](auto other) { return are_equal(one, other); })) {
        own.push_back(root_.append_copy(one));
      }
    }
  }

  void widen_header(pugi::xml_node other) {
    pugi::xml_node header = root_.child("header");
    const auto widen = [&](const char* side, bool up) {
      if (!header.attribute(side) || !other.attribute(side)) return;
      const double own = number(header, side), its = number(other, side);
      if (up ? its > own : its < own) set_text(header, side, other.attribute(side).value());
    };
    widen("north", true);
    widen("east", true);
    widen("south", false);
    widen("west", false);
  }

  // The first part of a road has its id, the others have ids of their own.
  void name_parts(const std::string& file, Merged& result) {
    FreshIds ids;
    for (const auto& [id, parts] : parts_) ids.take(id);
    for (auto& [id, parts] : parts_) {
      for (std::size_t i = 0; i < parts.size(); ++i) {
        const RoadCut cut = road_cut(parts[i]);
        open_parts_ += cut.is_whole() ? 0 : 1;
        const std::string before = text(parts[i], "id");
        const std::size_t source = origins_[before];
        const std::string now = i == 0 ? id : ids.fresh();
        set_text(parts[i], "id", now);
        origins_[now] = source;
        if (i > 0) result.renamed.push_back({file, "part of road " + id, before, now});
      }
    }
  }

  pugi::xml_node root_;
  const MergeOptions& options_;
  OfKinds in_order_;
  std::size_t source_ = 0;                                    // which of the files is being added
  std::map<std::string, std::vector<pugi::xml_node>> parts_;  // of each whole road
  geometry::DisjointSets maps_;  // files of which one has a part of a road of another
  std::map<std::string, std::size_t> origins_;                 // file of each road
  std::array<pugi::xml_node, kKinds.size()> last_;             // behind which new ones stand
  std::array<ById, kKinds.size()> by_id_;                      // of all kinds but roads
  std::map<std::string, std::vector<pugi::xml_node>> others_;  // by name
  std::array<TakenIds, 2> inside_ = {
      {{"signals", &NewIds::signals}, {"objects", &NewIds::objects}}};
  std::set<std::string> joined_;
  std::vector<Seam> seams_;
  std::size_t repeated_ = 0, open_parts_ = 0;
};

}  // namespace

Merged merge_open_drive(std::vector<MergeInput> inputs, const MergeOptions& options) {
  const std::string indent = indent_of(inputs.front().bytes);
  const Source first = read_source(std::move(inputs.front()));
  restore_references(first.root());
  Merger merger(first.root(), inputs.size(), options);
  Merged result;
  for (std::size_t i = 1; i < inputs.size(); ++i) {
    const Source source = read_source(std::move(inputs[i]));
    if (!options.same_system) {
      require_same_system(first.system, first.name, source.system, source.name);
    }
    restore_references(source.root());
    merger.add(source, result);
  }
  merger.finish(first.name, result);
  result.bytes = text_of(first.xml, indent);
  return result;
}

}  // namespace roadbed::map::edit::merging
