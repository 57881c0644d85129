#include "roadbed/map/edit/merging/lanelet_identities.h"

#include <algorithm>

#include "roadbed/map/edit/osm_edit.h"

namespace roadbed::map::inline edit::inline merging {
namespace {

using lanelet2::Document;
using lanelet2::Member;
using lanelet2::MemberKind;
using lanelet2::Relation;
using lanelet2::Way;

}  // namespace

OsmId renamed(const OsmNames& names, OsmId id) {
  const auto found = names.find(id);
  return found == names.end() ? id : found->second;
}

LaneletIdentities::LaneletIdentities(const std::vector<Document>& files,
                                     std::vector<Renamed>& renamings)
    : files_(files), names_(files.size()), renamings_(renamings) {
  for (const Document& file : files) next_id_ = std::max(next_id_, edit::free_id(file));
  for (std::size_t f = 0; f < files.size(); ++f) {
    read_parts(f);
    name_nodes(f);
    name_ways(f);
    name_relations(f);
  }
}

bool LaneletIdentities::is_first(std::size_t f, const Way& way, std::size_t i) const {
  return files_[f].way_index.find(way.id) == i;
}

// The parts of a file, by its own ids.
void LaneletIdentities::read_parts(std::size_t f) {
  parts_.clear();
  const Document& file = files_[f];
  for (std::size_t i = 0; i < file.ways.size(); ++i) {
    const Way& way = file.ways[i];
    if (!is_first(f, way, i)) continue;
    WayPart part{{span_of(way)}, f, i, {}};
    for (const std::uint32_t node : way.nodes) part.nodes.push_back(file.nodes[node].id);
    if (part.starts_at_cut()) names_[f].cut_nodes.insert(part.nodes.front());
    if (part.ends_at_cut()) names_[f].cut_nodes.insert(part.nodes.back());
    parts_.push_back(std::move(part));
  }
}

void LaneletIdentities::name_nodes(std::size_t f) {
  const Document& file = files_[f];
  for (std::size_t i = 0; i < file.nodes.size(); ++i) {
    const lanelet2::Node& node = file.nodes[i];
    if (file.node_index.find(node.id) != i) continue;
    const bool is_cut = names_[f].cut_nodes.contains(node.id);
    const auto found = nodes_.find(node.id);
    if (found == nodes_.end()) {
      nodes_.emplace(node.id, Place{f, i});
    } else if (is_cut || !is_same_node(found->second, {f, i})) {
      names_[f].nodes[node.id] = next_id_;
      if (!is_cut) renamings_.push_back(named(f, "node", node.id, next_id_));
      nodes_.emplace(next_id_++, Place{f, i});
    }
  }
}

Renamed LaneletIdentities::named(std::size_t f, const char* kind, OsmId from, OsmId to) const {
  return {files_[f].name, kind, std::to_string(from), std::to_string(to)};
}

bool LaneletIdentities::is_same_node(const Place& a, const Place& b) const {
  const auto text = [&](const Place& place) {
    const Document& file = files_[place.first];
    return xml_element_at(file.text, file.nodes[place.second].at);
  };
  if (text(a) == text(b)) return true;
  const lanelet2::NodePlace &one = files_[a.first].places[a.second],
                            &other = files_[b.first].places[b.second];
  const bool together =
      one.latitude_deg == other.latitude_deg && one.longitude_deg == other.longitude_deg;
  const bool by_degrees = together && !one.is_local() && !other.is_local();
  return by_degrees || OsmElement(text(a)).text() == OsmElement(text(b)).text();
}

std::string LaneletIdentities::said(std::size_t f, std::size_t at) const {
  return OsmElement(xml_element_at(files_[f].text, at)).said();
}

void LaneletIdentities::name_ways(std::size_t f) {
  for (WayPart& part : parts_) {
    for (OsmId& node : part.nodes) node = renamed(names_[f].nodes, node);
    const auto found = ways_.find(part.whole);
    if (found != ways_.end() && !is_one_line(found->second.front(), part)) {
      auto [name, is_new] = names_[f].ways.try_emplace(part.whole, next_id_);
      if (is_new) renamings_.push_back(named(f, "way", part.whole, next_id_++));
      part.whole = name->second;
    }
    ways_[part.whole].push_back(part);
  }
}

// Whether two parts are of one line: their points are the same where both have some.
bool LaneletIdentities::is_one_line(const WayPart& a, const WayPart& b) const {
  if (a.rows != b.rows) return false;
  if (said(a.file, files_[a.file].ways[a.way].at) != said(b.file, files_[b.file].ways[b.way].at))
    return false;
  for (std::size_t i = b.first_whole(); static_cast<double>(i) <= b.to; ++i) {
    const OsmId *one = a.at(i), *other = b.at(i);
    if (one != nullptr && other != nullptr && *one != *other) return false;
  }
  return true;
}

// The line that a member is, or is a part of.
OsmId LaneletIdentities::whole_way(std::size_t f, OsmId way) const {
  const auto index = files_[f].way_index.find(way);
  if (!index) return way;
  return renamed(names_[f].ways, span_of(files_[f].ways[*index]).whole);
}

void LaneletIdentities::name_relations(std::size_t f) {
  for (const Relation& relation : files_[f].relations) {
    const OsmId whole = whole_of(relation);
    std::string what = said(f, relation.at) + text_of(whole_members(f, relation));
    const auto [found, is_new] = relations_.try_emplace(whole, what);
    if (is_new || found->second == what || names_[f].relations.contains(whole)) continue;
    names_[f].relations[whole] = next_id_;
    renamings_.push_back(named(f, "relation", whole, next_id_));
    relations_.emplace(next_id_++, std::move(what));
  }
}

OsmId LaneletIdentities::whole_of(const Relation& relation) {
  const auto whole = lanelet2::id_in(tag_value(relation.tags, kClipKey));
  return relation.type == "lanelet" && whole ? *whole : relation.id;
}

// Its members in the whole map, as all files call them but for relations.
std::vector<Member> LaneletIdentities::whole_members(std::size_t f,
                                                     const Relation& relation) const {
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

}  // namespace roadbed::map::edit::merging
