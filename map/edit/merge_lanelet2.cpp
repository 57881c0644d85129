#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <map>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "roadbed/map/edit/coordinate_systems.h"
#include "roadbed/map/edit/merge.h"
#include "roadbed/map/edit/osm_edit.h"
#include "roadbed/map/edit/osm_seams.h"

namespace roadbed::map::inline edit {
namespace {

using lanelet2::Document;
using lanelet2::Member;
using lanelet2::MemberKind;
using lanelet2::Relation;
using lanelet2::Way;
using Id = std::int64_t;
using IdNames = std::map<Id, Id>;

constexpr double kSameFraction = 1e-6;  // of a segment: where two parts of a line meet

Id renamed(const IdNames& names, Id id) {
  const auto found = names.find(id);
  return found == names.end() ? id : found->second;
}

/// A part of a whole line, which all that is not cut is, too.
struct WayPart {
  std::size_t file = 0, way = 0;  ///< which of its file
  Id whole = 0;
  double from = 0.0, to = 0.0;
  std::size_t points = 0;  ///< of the whole line
  std::vector<Id> nodes;

  std::size_t first_whole() const { return static_cast<std::size_t>(std::ceil(from)); }
  bool starts_at_cut() const { return static_cast<double>(first_whole()) > from; }
  bool ends_at_cut() const { return std::floor(to) < to; }
  bool is_whole() const { return from <= 0.0 && to >= static_cast<double>(points - 1); }

  // The node of a point of the whole line; none if it is not in this part.
  const Id* at(std::size_t index) const {
    const std::size_t first = first_whole();
    if (index < first || static_cast<double>(index) > to) return nullptr;
    const std::size_t place = index - first + (starts_at_cut() ? 1 : 0);
    return place < nodes.size() ? &nodes[place] : nullptr;
  }
};

class LaneletMerger {
 public:
  LaneletMerger(const std::vector<Document>& files, const MergeOptions& options)
      : files_(files), options_(options), edit_(files.front()), names_(files.size()) {
    for (const Document& file : files) next_id_ = std::max(next_id_, free_id(file));
  }

  void run(Merged& result) {
    for (std::size_t f = 0; f < files_.size(); ++f) {
      read_parts(f);
      name_nodes(f, result);
      name_ways(f, result);
      name_relations(f, result);
    }
    join_seams(result);
    for (auto& [whole, parts] : ways_) put_together(whole, parts);
    for (std::size_t f = 0; f < files_.size(); ++f) write_lanelets(f);
    for (std::size_t f = 0; f < files_.size(); ++f) write_others(f);
    for (std::size_t f = 0; f < files_.size(); ++f) write_nodes(f);
    result.bytes = edit_.file();
    result.count("lines put together of parts", joined_);
    result.count("lines taken once that several maps hold", repeated_ways_);
    result.count("lanelets taken once that several maps hold, or put together of parts",
                 repeated_lanelets_);
    result.count("lanelets of which a part is missing", open_lanelets_);
  }

 private:
  struct Names {
    IdNames nodes, ways, relations;
    std::set<Id> cut_nodes;    // made by a clip
    std::map<Id, Id> way_now;  // what a line is called in the end
  };

  bool is_first(std::size_t f, const Way& way, std::size_t i) const {
    return files_[f].way_index.find(way.id) == i;
  }

  // The parts of a file, by its own ids.
  void read_parts(std::size_t f) {
    parts_.clear();
    const Document& file = files_[f];
    for (std::size_t i = 0; i < file.ways.size(); ++i) {
      const Way& way = file.ways[i];
      if (!is_first(f, way, i)) continue;
      WayPart part{f, i, way.id, 0.0, static_cast<double>(way.nodes.size()) - 1.0, way.nodes.size(),
                   {}};
      for (const std::uint32_t node : way.nodes) part.nodes.push_back(file.nodes[node].id);
      read_cut(std::string(tag_value(way.tags, kClipKey)), part);
      if (part.starts_at_cut()) names_[f].cut_nodes.insert(part.nodes.front());
      if (part.ends_at_cut()) names_[f].cut_nodes.insert(part.nodes.back());
      parts_.push_back(std::move(part));
    }
  }

  static void read_cut(const std::string& text, WayPart& part) {
    WayPart cut = part;
    long long whole = 0;
    if (std::sscanf(text.c_str(), "%lld %lf %lf %zu", &whole, &cut.from, &cut.to, &cut.points) != 4)
      return;
    cut.whole = whole;
    const bool fits = cut.from >= 0.0 && cut.from < cut.to && cut.points < 100'000'000 &&
                      cut.to <= static_cast<double>(cut.points - 1);
    const double inner = std::floor(cut.to) - std::ceil(cut.from) + 1.0;
    const auto nodes = static_cast<std::size_t>(std::max(0.0, inner)) +
                       (cut.starts_at_cut() ? 1 : 0) + (cut.ends_at_cut() ? 1 : 0);
    if (fits && nodes == part.nodes.size()) part = cut;
  }

  void name_nodes(std::size_t f, Merged& result) {
    const Document& file = files_[f];
    for (std::size_t i = 0; i < file.nodes.size(); ++i) {
      const lanelet2::Node& node = file.nodes[i];
      if (file.node_index.find(node.id) != i) continue;
      const bool is_cut = names_[f].cut_nodes.contains(node.id);
      const auto found = nodes_.find(node.id);
      if (found == nodes_.end()) {
        nodes_.emplace(node.id, std::pair{f, i});
      } else if (is_cut || !is_same_node(found->second, {f, i})) {
        names_[f].nodes[node.id] = next_id_;
        if (!is_cut) result.renamed.push_back(named(f, "node", node.id, next_id_));
        nodes_.emplace(next_id_++, std::pair{f, i});
      }
    }
  }

  Renamed named(std::size_t f, const char* kind, Id from, Id to) const {
    return {files_[f].name, kind, std::to_string(from), std::to_string(to)};
  }

  using Place = std::pair<std::size_t, std::size_t>;  // file, index

  bool is_same_node(const Place& a, const Place& b) const {
    const auto text = [&](const Place& place) {
      const Document& file = files_[place.first];
      return element_text(file.text, file.nodes[place.second].at);
    };
    if (text(a) == text(b)) return true;
    const lanelet2::NodePlace &one = files_[a.first].places[a.second],
                              &other = files_[b.first].places[b.second];
    const bool together =
        one.latitude_deg == other.latitude_deg && one.longitude_deg == other.longitude_deg;
    const bool by_degrees = together && !one.is_local() && !other.is_local();
    return by_degrees || OsmElement(text(a)).text() == OsmElement(text(b)).text();
  }

  std::string said(std::size_t f, std::size_t at) const {
    return OsmElement(element_text(files_[f].text, at)).said();
  }

  void name_ways(std::size_t f, Merged& result) {
    for (WayPart& part : parts_) {
      for (Id& node : part.nodes) node = renamed(names_[f].nodes, node);
      const auto found = ways_.find(part.whole);
      if (found != ways_.end() && !is_one_line(found->second.front(), part)) {
        auto [name, is_new] = names_[f].ways.try_emplace(part.whole, next_id_);
        if (is_new) result.renamed.push_back(named(f, "way", part.whole, next_id_++));
        part.whole = name->second;
      }
      ways_[part.whole].push_back(part);
    }
  }

  // Whether two parts are of one line: their points are the same where both have some.
  bool is_one_line(const WayPart& a, const WayPart& b) const {
    if (a.points != b.points) return false;
    if (said(a.file, files_[a.file].ways[a.way].at) != said(b.file, files_[b.file].ways[b.way].at))
      return false;
    for (std::size_t i = b.first_whole(); static_cast<double>(i) <= b.to; ++i) {
      const Id *one = a.at(i), *other = b.at(i);
      if (one != nullptr && other != nullptr && *one != *other) return false;
    }
    return true;
  }

  static Id whole_of(const Relation& relation) {
    const auto whole = lanelet2::id_in(tag_value(relation.tags, kClipKey));
    return relation.type == "lanelet" && whole ? *whole : relation.id;
  }

  // The line that a member is, or is a part of.
  Id whole_way(std::size_t f, Id way) const {
    const auto index = files_[f].way_index.find(way);
    if (!index) return way;
    WayPart part{f, *index, way, 0.0, 0.0, 0, {}};
    const Way& text = files_[f].ways[*index];
    part.nodes.resize(text.nodes.size());
    read_cut(std::string(tag_value(text.tags, kClipKey)), part);
    return renamed(names_[f].ways, part.whole);
  }

  // Its members in the whole map, as all files call them but for relations.
  std::vector<Member> whole_members(std::size_t f, const Relation& relation) const {
    std::vector<Member> members(relation.members.begin(), relation.members.end());
    if (relation.type != "lanelet") {
      if (auto kept = members_in(tag_value(relation.tags, kClipKey))) {
        if (!kept->empty()) members = *std::move(kept);
      }
    }
    for (Member& member : members) {
      if (member.kind == MemberKind::node) member.id = renamed(names_[f].nodes, member.id);
      if (member.kind == MemberKind::way) member.id = whole_way(f, member.id);
    }
    return members;
  }

  void name_relations(std::size_t f, Merged& result) {
    for (const Relation& relation : files_[f].relations) {
      const Id whole = whole_of(relation);
      std::string what = said(f, relation.at) + text_of(whole_members(f, relation));
      const auto [found, is_new] = relations_.try_emplace(whole, what);
      if (is_new || found->second == what || names_[f].relations.contains(whole)) continue;
      names_[f].relations[whole] = next_id_;
      result.renamed.push_back(named(f, "relation", whole, next_id_));
      relations_.emplace(next_id_++, std::move(what));
    }
  }

  // Nodes where lanelets of different files meet become one.
  void join_seams(Merged& result) {
    const auto called = [&](std::size_t f, Id node) { return renamed(names_[f].nodes, node); };
    const IdNames one = nodes_to_join(files_, called, options_.tolerance_m, result.seams);
    for (auto& [whole, parts] : ways_) {
      for (WayPart& part : parts) {
        for (Id& node : part.nodes) node = renamed(one, node);
      }
    }
    for (const auto& [from, to] : one) joined_nodes_.insert(from);
  }

  // Parts in order; those that meet or overlap become one.
  void put_together(Id whole, std::vector<WayPart>& parts) {
    std::stable_sort(parts.begin(), parts.end(),
                     [](const WayPart& a, const WayPart& b) { return a.from < b.from; });
    std::vector<std::vector<const WayPart*>> groups;
    double to = -1.0;
    for (const WayPart& part : parts) {
      if (groups.empty() || part.from > to + kSameFraction) groups.emplace_back();
      to = groups.back().empty() ? part.to : std::max(to, part.to);
      groups.back().push_back(&part);
    }
    for (std::size_t i = 0; i < groups.size(); ++i) {
      write_way(groups[i], i == 0 ? whole : next_id_++);
    }
  }

  void write_way(const std::vector<const WayPart*>& group, Id id) {
    const WayPart& first = *group.front();
    WayPart all = first;
    for (const WayPart* part : group) all.to = std::max(all.to, part->to);
    all.nodes.clear();
    if (first.starts_at_cut()) all.nodes.push_back(first.nodes.front());
    for (std::size_t i = all.first_whole(); static_cast<double>(i) <= all.to; ++i) {
      for (const WayPart* part : group) {
        if (const Id* node = part->at(i)) {
          all.nodes.push_back(*node);
          break;
        }
      }
    }
    for (const WayPart* part : group) {
      if (part->to == all.to && part->ends_at_cut()) {
        all.nodes.push_back(part->nodes.back());
        break;
      }
    }
    used_nodes_.insert(all.nodes.begin(), all.nodes.end());
    for (const WayPart* part : group) {
      names_[part->file].way_now[files_[part->file].ways[part->way].id] = id;
      if (part == &first) continue;
      if (part->file == 0) edit_.drop(files_[0].ways[part->way].at);
    }
    whole_ways_[id] = all.is_whole();
    const bool is_more = all.to > first.to;
    joined_ += is_more ? 1 : 0;
    repeated_ways_ += is_more ? 0 : group.size() - 1;
    put_way(all, id);
  }

  void put_way(const WayPart& part, Id id) {
    const Document& file = files_[part.file];
    const Way& way = file.ways[part.way];
    std::vector<Id> before;
    for (const std::uint32_t node : way.nodes) before.push_back(file.nodes[node].id);
    const bool was_cut = !tag_value(way.tags, kClipKey).empty();
    if (part.file == 0 && id == way.id && before == part.nodes && !was_cut) return;
    OsmElement element(element_text(file.text, way.at));
    element.set_attribute("id", std::to_string(id));
    if (before != part.nodes) element.set_nodes(part.nodes);
    if (part.is_whole()) {
      element.remove_tag(kClipKey);
    } else {
      element.set_tag(kClipKey,
                      fmt::format("{} {} {} {}", part.whole, part.from, part.to, part.points));
    }
    put(part.file, MemberKind::way, way.at, element.text());
  }

  // In place in the first file, behind the others of its kind from another.
  void put(std::size_t f, MemberKind kind, std::size_t at, const std::string& text) {
    f == 0 ? edit_.replace(at, text) : edit_.add(kind, text);
  }

  void drop(std::size_t f, std::size_t at) {
    if (f == 0) edit_.drop(at);
  }

  std::vector<Member> members_now(std::size_t f, const Relation& relation) const {
    std::vector<Member> members(relation.members.begin(), relation.members.end());
    for (Member& member : members) {
      if (member.kind == MemberKind::way) member.id = renamed(names_[f].way_now, member.id);
      if (member.kind == MemberKind::node) member.id = renamed(names_[f].nodes, member.id);
      if (member.kind == MemberKind::relation) {
        member.id = renamed(names_[f].relations, member.id);
      }
    }
    return members;
  }

  void write_lanelets(std::size_t f) {
    for (const Relation& relation : files_[f].relations) {
      if (relation.type != "lanelet") continue;
      const Id whole = renamed(names_[f].relations, whole_of(relation));
      const std::vector<Member> members = members_now(f, relation);
      auto& parts = lanelets_[whole];
      const std::string key = text_of(members);
      if (std::any_of(parts.begin(), parts.end(), [&](auto& part) { return part.first == key; })) {
        ++repeated_lanelets_;
        drop(f, relation.at);
        continue;
      }
      const Id id = parts.empty() ? whole : next_id_++;
      parts.emplace_back(key, id);
      const bool is_whole = std::all_of(members.begin(), members.end(), [&](const Member& member) {
        const auto way = whole_ways_.find(member.id);
        return member.kind != MemberKind::way || way == whole_ways_.end() || way->second;
      });
      open_lanelets_ += is_whole ? 0 : 1;
      const bool was_cut = !tag_value(relation.tags, kClipKey).empty();
      const bool same_members = key == text_of(relation.members);
      if (f == 0 && id == relation.id && same_members && is_whole && !was_cut) continue;
      OsmElement element(element_text(files_[f].text, relation.at));
      element.set_attribute("id", std::to_string(id));
      if (!same_members) element.set_members(members);
      if (is_whole) {
        element.remove_tag(kClipKey);
      } else {
        element.set_tag(kClipKey, std::to_string(whole));
      }
      put(f, MemberKind::relation, relation.at, element.text());
    }
    for (const Relation& relation : files_[f].relations) {
      if (relation.type != "lanelet") others_.insert(renamed(names_[f].relations, relation.id));
    }
  }

  void write_others(std::size_t f) {
    for (const Relation& relation : files_[f].relations) {
      if (relation.type == "lanelet") continue;
      const Id id = renamed(names_[f].relations, relation.id);
      if (!written_.insert(id).second) {
        drop(f, relation.at);
        continue;
      }
      const std::vector<Member> whole = whole_members(f, relation);
      std::vector<Member> members;
      for (const Member& member : whole) add_present(f, member, members);
      OsmElement element(element_text(files_[f].text, relation.at));
      element.set_attribute("id", std::to_string(id));
      if (text_of(members) != text_of(relation.members)) element.set_members(members);
      if (text_of(members) == text_of(whole)) {
        element.remove_tag(kClipKey);
      } else {
        element.set_tag(kClipKey, text_of(whole));
      }
      put(f, MemberKind::relation, relation.at, element.text());
    }
  }

  void add_present(std::size_t f, const Member& member, std::vector<Member>& members) const {
    if (member.kind != MemberKind::relation) {
      members.push_back(member);
      return;
    }
    const Id id = renamed(names_[f].relations, member.id);
    const auto parts = lanelets_.find(id);
    if (parts != lanelets_.end()) {
      for (const auto& [key, part] : parts->second)
        members.push_back({member.kind, part, member.role});
    } else if (others_.contains(id)) {
      members.push_back({member.kind, id, member.role});
    }
  }

  // Those that a clip made are no longer needed where lines are put together.
  void write_nodes(std::size_t f) {
    for (std::size_t i = 0; i < files_[f].nodes.size(); ++i) {
      const lanelet2::Node& node = files_[f].nodes[i];
      const Id id = renamed(names_[f].nodes, node.id);
      const auto own = nodes_.find(id);
      const bool is_own = own != nodes_.end() && own->second == Place{f, i};
      const bool is_gone = (names_[f].cut_nodes.contains(node.id) && !used_nodes_.contains(id)) ||
                           joined_nodes_.contains(id);
      if (!is_own || is_gone) {
        drop(f, node.at);
      } else if (f > 0) {
        OsmElement element(element_text(files_[f].text, node.at));
        if (id != node.id) element.set_attribute("id", std::to_string(id));
        edit_.add(MemberKind::node, element.text());
      }
    }
  }

  const std::vector<Document>& files_;
  const MergeOptions& options_;
  OsmEdit edit_;
  Id next_id_ = 1;
  std::vector<Names> names_;                 // of each file
  std::vector<WayPart> parts_;               // of the file that is being read
  std::map<Id, Place> nodes_;                // of the merged map
  std::map<Id, std::vector<WayPart>> ways_;  // of each whole line
  std::map<Id, std::string> relations_;      // what each whole relation says
  std::map<Id, bool> whole_ways_;            // whether a line of the merged map is whole
  std::map<Id, std::vector<std::pair<std::string, Id>>> lanelets_;  // parts: members, id
  std::set<Id> others_, written_, used_nodes_, joined_nodes_;
  std::size_t joined_ = 0, repeated_ways_ = 0, repeated_lanelets_ = 0, open_lanelets_ = 0;
};

bool has_local_coordinates(const Document& file) {
  return std::any_of(file.places.begin(), file.places.end(),
                     [](const lanelet2::NodePlace& place) { return place.is_local(); });
}

}  // namespace

Merged merge_lanelet2(std::vector<MergeInput> inputs, const MergeOptions& options) {
  std::vector<Document> files;
  for (MergeInput& input : inputs) {
    files.push_back(lanelet2::read_document(std::move(input.bytes), input.name));
    const Document &first = files.front(), &file = files.back();
    const bool by_latitude = !has_local_coordinates(first) && !has_local_coordinates(file);
    if (!by_latitude && !options.same_system) {
      CoordinateSystem system, other;
      system.crs = first.crs, other.crs = file.crs;
      require_same_system(system, first.name, other, file.name);
    }
  }
  Merged result;
  LaneletMerger(files, options).run(result);
  return result;
}

}  // namespace roadbed::map::edit
