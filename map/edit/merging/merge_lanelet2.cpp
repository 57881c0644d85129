#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "roadbed/map/edit/merging/coordinate_systems.h"
#include "roadbed/map/edit/merging/lanelet_identities.h"
#include "roadbed/map/edit/merging/merge.h"
#include "roadbed/map/edit/merging/osm_seams.h"
#include "roadbed/map/edit/osm_edit.h"

namespace roadbed::map::inline edit::inline merging {
namespace {

constexpr double kSameFraction = 1e-6;  // of a segment: where two parts of a line meet

using lanelet2::Document;
using lanelet2::Member;
using lanelet2::MemberKind;
using lanelet2::Relation;
using lanelet2::Way;
class LaneletMerger {
 public:
  LaneletMerger(const std::vector<Document>& files, const MergeOptions& options, Merged& result)
      : files_(files),
        options_(options),
        edit_(files.front()),
        one_(files, result.renamed),
        next_id_(one_.free_id()),
        ways_(one_.take_ways()),
        way_now_(files.size()) {}

  void run(Merged& result) {
    join_seams(result);
    for (auto& [whole, parts] : ways_) put_together(whole, parts);
    for (std::size_t f = 0; f < files_.size(); ++f) write_lanelets(f);
    for (std::size_t f = 0; f < files_.size(); ++f) write_others(f);
    for (std::size_t f = 0; f < files_.size(); ++f) write_nodes(f);
    result.bytes = std::move(edit_).file();
    result.count("lines put together of parts", joined_);
    result.count("lines taken once that several maps hold", repeated_ways_);
    result.count("lanelets taken once that several maps hold, or put together of parts",
                 repeated_lanelets_);
    result.count("lanelets of which a part is missing", open_lanelets_);
  }

 private:
  // Nodes where lanelets of different files meet become one.
  void join_seams(Merged& result) {
    const auto called = [&](std::size_t f, OsmId node) {
      return renamed(one_.names(f).nodes, node);
    };
    const auto lanelet_called = [&](std::size_t f, OsmId lanelet) {
      return renamed(one_.names(f).relations, lanelet);
    };
    const OsmNames one =
        nodes_to_join(files_, called, lanelet_called, options_.tolerance_m, result.seams);
    for (auto& [whole, parts] : ways_) {
      for (WayPart& part : parts) {
        for (OsmId& node : part.nodes) node = renamed(one, node);
      }
    }
    for (const auto& [from, to] : one) joined_nodes_.insert(from);
  }

  // Parts in order; those that meet or overlap become one.
  void put_together(OsmId whole, std::vector<WayPart>& parts) {
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

  void write_way(const std::vector<const WayPart*>& group, OsmId id) {
    const WayPart& first = *group.front();
    WayPart all = first;
    for (const WayPart* part : group) all.to = std::max(all.to, part->to);
    all.nodes.clear();
    if (first.starts_at_cut()) all.nodes.push_back(first.nodes.front());
    for (std::size_t i = all.first_whole(); static_cast<double>(i) <= all.to; ++i) {
      for (const WayPart* part : group) {
        if (const OsmId* node = part->at(i)) {
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
      way_now_[part->file][files_[part->file].ways[part->way].id] = id;
      if (part == &first) continue;
      if (part->file == 0) edit_.drop(files_[0].ways[part->way].at);
    }
    whole_ways_[id] = all.is_whole();
    const bool is_more = all.to > first.to;
    joined_ += is_more ? 1 : 0;
    repeated_ways_ += is_more ? 0 : group.size() - 1;
    put_way(all, id);
  }

  void put_way(const WayPart& part, OsmId id) {
    const Document& file = files_[part.file];
    const Way& way = file.ways[part.way];
    std::vector<OsmId> before;
    for (const std::uint32_t node : way.nodes) before.push_back(file.nodes[node].id);
    const bool was_cut = !tag_value(way.tags, kClipKey).empty();
    if (part.file == 0 && id == way.id && before == part.nodes && !was_cut) return;
    OsmElement element(xml_element_at(file.text, way.at));
    element.set_attribute("id", std::to_string(id));
    if (before != part.nodes) element.set_nodes(part.nodes);
    if (part.is_whole()) {
      element.remove_tag(kClipKey);
    } else {
      element.set_tag(kClipKey,
                      fmt::format("{} {} {} {}", part.whole, part.from, part.to, part.rows));
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
      if (member.kind == MemberKind::way) member.id = renamed(way_now_[f], member.id);
      if (member.kind == MemberKind::node) member.id = renamed(one_.names(f).nodes, member.id);
      if (member.kind == MemberKind::relation) {
        member.id = renamed(one_.names(f).relations, member.id);
      }
    }
    return members;
  }

  void write_lanelets(std::size_t f) {
    for (const Relation& relation : files_[f].relations) {
      if (relation.type != "lanelet") continue;
      const OsmId whole = renamed(one_.names(f).relations, LaneletIdentities::whole_of(relation));
      const std::vector<Member> members = members_now(f, relation);
      auto& parts = lanelets_[whole];
      const std::string key = text_of(members);
      if (std::any_of(parts.begin(), parts.end(), [&](auto& part) { return part.first == key; })) {
        ++repeated_lanelets_;
        drop(f, relation.at);
        continue;
      }
      const OsmId id = parts.empty() ? whole : next_id_++;
      parts.emplace_back(key, id);
      const bool is_whole = std::all_of(members.begin(), members.end(), [&](const Member& member) {
        const auto way = whole_ways_.find(member.id);
        return member.kind != MemberKind::way || way == whole_ways_.end() || way->second;
      });
      open_lanelets_ += is_whole ? 0 : 1;
      const bool was_cut = !tag_value(relation.tags, kClipKey).empty();
      const bool same_members = key == text_of(relation.members);
      if (f == 0 && id == relation.id && same_members && is_whole && !was_cut) continue;
      OsmElement element(xml_element_at(files_[f].text, relation.at));
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
      if (relation.type != "lanelet") others_.insert(renamed(one_.names(f).relations, relation.id));
    }
  }

  void write_others(std::size_t f) {
    for (const Relation& relation : files_[f].relations) {
      if (relation.type == "lanelet") continue;
      const OsmId id = renamed(one_.names(f).relations, relation.id);
      if (!written_.insert(id).second) {
        drop(f, relation.at);
        continue;
      }
      const std::vector<Member> whole = one_.whole_members(f, relation);
      std::vector<Member> members;
      for (const Member& member : whole) add_present(f, member, members);
      OsmElement element(xml_element_at(files_[f].text, relation.at));
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
    const OsmId id = renamed(one_.names(f).relations, member.id);
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
      const OsmId id = renamed(one_.names(f).nodes, node.id);
      const auto own = one_.nodes().find(id);
      const bool is_own = own != one_.nodes().end() && own->second == std::pair{f, i};
      const bool is_gone =
          (one_.names(f).cut_nodes.contains(node.id) && !used_nodes_.contains(id)) ||
          joined_nodes_.contains(id);
      if (!is_own || is_gone) {
        drop(f, node.at);
      } else if (f > 0) {
        OsmElement element(xml_element_at(files_[f].text, node.at));
        if (id != node.id) element.set_attribute("id", std::to_string(id));
        edit_.add(MemberKind::node, element.text());
      }
    }
  }

  const std::vector<Document>& files_;
  const MergeOptions& options_;
  OsmEdit edit_;
  LaneletIdentities one_;
  OsmId next_id_;
  std::map<OsmId, std::vector<WayPart>> ways_;  // of each whole line, ends joined
  std::vector<OsmNames> way_now_;               // what each file's lines are called in the end
  std::map<OsmId, bool> whole_ways_;            // whether a line of the merged map is whole
  std::map<OsmId, std::vector<std::pair<std::string, OsmId>>> lanelets_;  // parts: members, id
  std::set<OsmId> others_, written_, used_nodes_, joined_nodes_;
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
  LaneletMerger(files, options, result).run(result);
  return result;
}

}  // namespace roadbed::map::edit::merging
