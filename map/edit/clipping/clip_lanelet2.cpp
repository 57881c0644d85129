#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "roadbed/geometry/polygons/polygon.h"
#include "roadbed/map/edit/clipping/clip.h"
#include "roadbed/map/edit/clipping/lanelet_index.h"
#include "roadbed/map/edit/clipping/line_spans.h"
#include "roadbed/map/edit/clipping/osm_nodes.h"
#include "roadbed/map/edit/clipping/osm_part.h"
#include "roadbed/map/edit/osm_edit.h"

namespace roadbed::map::inline edit::inline clipping {
namespace {

using Eigen::Vector2d;
using lanelet2::Document;
using lanelet2::Member;
using lanelet2::MemberKind;
using lanelet2::Relation;
using lanelet2::Way;

class LaneletClipper {
 public:
  LaneletClipper(const Document& document, const LaneletIndex& index, const OsmLayout& layout,
                 const Region& region, const ClipOptions& options)
      : document_(document),
        index_(index),
        region_(region),
        options_(options),
        edit_(layout),
        nodes_(document),
        next_id_(index.free_id()),
        spans_(document.ways.size()),
        role_(index.roles()),
        forced_(document.ways.size(), false),
        node_stays_(document.nodes.size(), false),
        relation_stays_(document.relations.size(), false),
        way_stays_(document.ways.size(), false) {}

  void run(Edited& result) {
    for (const std::uint32_t way : index_.ways_near(region_)) {
      spans_[way] = spans_inside(index_.line_of(way), region_);
    }
    for (const std::uint32_t i : index_.lanelets_near(region_)) {
      if (touches(index_.lanelets()[i])) keep(index_.lanelets()[i]);
    }
    if (strips_.empty()) {
      result.reason = "no lanelet of the map reaches into the region";
      const auto left_out =
          std::ranges::count_if(spans_, [](const auto& spans) { return !spans.empty(); });
      result.count("lines left out with it", static_cast<std::size_t>(left_out));
      return;
    }
    keep_other_relations();
    force_matching();
    keep_ways();
    write_strips();
    write_relations();
    write_nodes();
    result.bytes = std::move(edit_).file();
    result.count("lanelets kept whole", strips_.size() - cut_);
    result.count("lanelets cut", cut_);
    result.count("parts of lanelets with an id of their own", parts_);
    result.count("lanelets at the border that cannot be cut, kept whole", uncut_);
    result.count("lanelets outside, left out", index_.lanelets().size() - strips_.size());
    result.count("lanelets without two usable borders, left out", index_.unusable());
    result.count("relations that lost members outside", thinned_);
  }

 private:
  std::size_t points(std::uint32_t way) const { return document_.ways[way].nodes.size(); }

  void keep(const LaneletWays& lanelet) {
    for (const std::uint32_t way : lanelet.ways) {
      if (role_[way] == WayRole::alone) role_[way] = WayRole::border;
    }
    relation_stays_[lanelet.relation] = true;
    strips_.push_back(&lanelet);
  }

  std::vector<Vector2d> along(const LaneletWays& lanelet, std::size_t i) const {
    std::vector<Vector2d> line = index_.line_of(lanelet.ways[i]);
    if (lanelet.reversed[i]) std::reverse(line.begin(), line.end());
    return line;
  }

  bool touches(const LaneletWays& strip) const {
    if (!spans_[strip.ways[0]].empty() || !spans_[strip.ways[1]].empty()) return true;
    geometry::Ring ring = along(strip, 0);
    const std::vector<Vector2d> right = along(strip, 1);
    ring.insert(ring.end(), right.rbegin(), right.rend());
    const geometry::Box box = geometry::box_around(ring);
    if (region_.side_of_disc(box.center(), 0.5 * box.diagonal().norm()) == Region::Side::outside) {
      return false;
    }
    return region_.touches(ring.front(), right.front()) ||
           region_.touches(ring[ring.size() - right.size() - 1], right.back()) ||
           std::any_of(region_.corners().begin(), region_.corners().end(),
                       [&](const Vector2d& corner) { return geometry::contains(ring, corner); });
  }

  bool member_stays(const Member& member) const {
    if (member.kind == MemberKind::relation) {
      const auto found = document_.relation_index.find(member.id);
      return found && relation_stays_[*found];
    }
    if (member.kind == MemberKind::node) {
      const auto found = document_.node_index.find(member.id);
      return found && document_.nodes[*found].placed &&
             region_.contains(document_.nodes[*found].in_map.head<2>() +
                              document_.origin_in_source);
    }
    const auto found = document_.way_index.find(member.id);
    return found && !spans_[*found].empty();
  }

  // Regulatory elements of lanelets that stay, areas and others that have anything inside; the
  // lines of all of these are not cut.
  void keep_other_relations() {
    std::set<std::int64_t> named;
    for (const LaneletWays* strip : strips_) {
      for (const Member& member : document_.relations[strip->relation].members) {
        if (member.kind == MemberKind::relation) named.insert(member.id);
      }
    }
    for (std::uint32_t i = 0; i < document_.relations.size(); ++i) {
      const Relation& relation = document_.relations[i];
      if (relation.type == "lanelet") continue;
      const bool speaks_to_lanes =
          std::any_of(relation.members.begin(), relation.members.end(),
                      [](const Member& m) { return m.kind == MemberKind::relation; });
      const auto stays = [&](const Member& member) {
        return (!speaks_to_lanes || member.kind == MemberKind::relation) && member_stays(member);
      };
      if (!named.contains(relation.id) &&
          std::none_of(relation.members.begin(), relation.members.end(), stays)) {
        continue;
      }
      relation_stays_[i] = true;
      for (const Member& member : relation.members) keep_member_whole(member);
    }
  }

  void keep_member_whole(const Member& member) {
    if (member.kind == MemberKind::way) {
      if (const auto way = document_.way_index.find(member.id)) {
        role_[*way] = WayRole::fixed;
        way_stays_[*way] = true;
      }
    } else if (member.kind == MemberKind::node) {
      if (const auto node = document_.node_index.find(member.id)) node_stays_[*node] = true;
    }
  }

  bool is_whole_line(std::uint32_t way) const {
    return forced_[way] || is_whole(spans_[way], points(way));
  }

  std::vector<LineSpan> spans_along(const LaneletWays& strip, std::size_t i) const {
    const auto& spans = spans_[strip.ways[i]];
    return strip.reversed[i] ? reversed(spans, points(strip.ways[i])) : spans;
  }

  bool can_be_cut(const LaneletWays& strip) const {
    for (std::size_t i = 0; i < strip.ways.size(); ++i) {
      const std::uint32_t way = strip.ways[i];
      // Without a stretch inside, only an end of the lanelet or a corner of the region is.
      if (forced_[way] || role_[way] == WayRole::fixed || spans_[way].empty()) return false;
      if (!correspond(spans_along(strip, 0), points(strip.ways[0]), spans_along(strip, i),
                      points(way))) {
        return false;
      }
    }
    return true;
  }

  // A lanelet that cannot be cut stays whole, and so do those that share a line of it.
  void force_matching() {
    std::map<std::uint32_t, std::vector<std::size_t>> users;
    std::vector<std::size_t> open;
    for (std::size_t i = 0; i < strips_.size(); ++i) {
      for (const std::uint32_t way : strips_[i]->ways) users[way].push_back(i);
      open.push_back(i);
    }
    while (!open.empty()) {
      const LaneletWays& strip = *strips_[open.back()];
      open.pop_back();
      const bool whole = std::all_of(strip.ways.begin(), strip.ways.end(),
                                     [&](std::uint32_t way) { return is_whole_line(way); });
      if (whole || (!options_.whole && can_be_cut(strip))) continue;
      uncut_ += options_.whole ? 0 : 1;
      for (const std::uint32_t way : strip.ways) {
        if (is_whole_line(way)) continue;
        forced_[way] = true;
        open.insert(open.end(), users[way].begin(), users[way].end());
      }
    }
    for (const LaneletWays* strip : strips_) {
      for (const std::uint32_t way : strip->ways) way_stays_[way] = true;
    }
  }

  void keep_ways() {
    for (std::uint32_t i = 0; i < document_.ways.size(); ++i) {
      const bool alone = role_[i] == WayRole::alone;
      if (!way_stays_[i] && (role_[i] == WayRole::border || spans_[i].empty())) {
        continue;
      }
      way_stays_[i] = true;
      const bool whole = forced_[i] || role_[i] == WayRole::fixed || options_.whole ||
                         is_whole(spans_[i], points(i));
      ids_[i] = {document_.ways[i].id};
      if (!whole && (alone || role_[i] == WayRole::border)) {
        cut_way(i);
      } else {
        edit_.keep(document_.ways[i].at);
        for (const std::uint32_t node : document_.ways[i].nodes) node_stays_[node] = true;
      }
    }
  }

  void cut_way(std::uint32_t index) {
    const Way& way = document_.ways[index];
    const WaySpan before = span_of(way);
    for (std::size_t k = 0; k < spans_[index].size(); ++k) {
      if (k > 0) ids_[index].push_back(next_id_++);
      OsmElement element(edit_.text_of(way.at));
      const LineSpan& span = spans_[index][k];
      element.set_nodes(nodes_along(way, span));
      const RowSpan part = before.part(span.from, span.to);
      element.set_tag(kClipKey,
                      fmt::format("{} {} {} {}", before.whole, part.from, part.to, part.rows));
      element.set_attribute("id", std::to_string(ids_[index][k]));
      k == 0 ? edit_.keep(way.at, element.text()) : edit_.add(MemberKind::way, element.text());
    }
  }

  std::vector<std::int64_t> nodes_along(const Way& way, const LineSpan& span) {
    std::vector<std::int64_t> ids;
    const double first = std::ceil(span.from), last = std::floor(span.to);
    if (first > span.from) ids.push_back(add_node(way, span.from));
    for (double i = first; i <= last; ++i) {
      const std::uint32_t node = way.nodes[static_cast<std::size_t>(i)];
      node_stays_[node] = true;
      ids.push_back(document_.nodes[node].id);
    }
    if (last < span.to) ids.push_back(add_node(way, span.to));
    return ids;
  }

  std::int64_t add_node(const Way& way, double place) {
    const auto i = static_cast<std::size_t>(place);
    const std::int64_t id = next_id_++;
    edit_.add(MemberKind::node,
              nodes_.between(way.nodes[i], way.nodes[i + 1], place - static_cast<double>(i), id));
    return id;
  }

  std::int64_t id_of_part(const LaneletWays& strip, std::size_t way, std::size_t part) const {
    const auto& ids = ids_.at(strip.ways[way]);
    return strip.reversed[way] ? ids[ids.size() - 1 - part] : ids[part];
  }

  void write_strips() {
    for (const LaneletWays* const kept : strips_) {
      const LaneletWays& strip = *kept;
      const Relation& relation = document_.relations[strip.relation];
      relation_parts_[relation.id] = {relation.id};
      const std::size_t parts = ids_.at(strip.ways[0]).size();
      const bool whole = std::all_of(strip.ways.begin(), strip.ways.end(), [&](std::uint32_t way) {
        return is_whole_line(way) || role_[way] == WayRole::fixed || options_.whole;
      });
      if (whole) {
        edit_.keep(relation.at);
        continue;
      }
      ++cut_;
      for (std::size_t k = 0; k < parts; ++k) write_part(strip, relation, k);
    }
  }

  void write_part(const LaneletWays& strip, const Relation& relation, std::size_t part) {
    std::vector<Member> members(relation.members.begin(), relation.members.end());
    for (Member& member : members) {
      for (std::size_t i = 0; i < strip.ways.size(); ++i) {
        if (member.kind == MemberKind::way && member.id == document_.ways[strip.ways[i]].id) {
          member.id = id_of_part(strip, i, part);
        }
      }
    }
    OsmElement element(edit_.text_of(relation.at));
    element.set_members(members);
    remember(relation, std::to_string(relation.id), element);
    if (part == 0) {
      edit_.keep(relation.at, element.text());
      return;
    }
    ++parts_;
    relation_parts_[relation.id].push_back(next_id_);
    element.set_attribute("id", std::to_string(next_id_++));
    edit_.add(MemberKind::relation, element.text());
  }

  // What was remembered before stays: it is of the whole map.
  static void remember(const Relation& relation, const std::string& what, OsmElement& element) {
    if (tag_value(relation.tags, kClipKey).empty()) element.set_tag(kClipKey, what);
  }

  void write_relations() {
    for (std::uint32_t i = 0; i < document_.relations.size(); ++i) {
      const Relation& relation = document_.relations[i];
      if (relation_stays_[i] && relation.type != "lanelet") write_relation(relation);
    }
  }

  // Without the lanelets that are not there, and with all parts of those that are in parts.
  void write_relation(const Relation& relation) {
    std::vector<Member> members;
    bool changed = false;
    for (const Member& member : relation.members) {
      if (member.kind != MemberKind::relation) {
        members.push_back(member);
        continue;
      }
      const auto found = document_.relation_index.find(member.id);
      const bool stays = !found || relation_stays_[*found];
      changed = changed || !stays;
      const auto parts = relation_parts_.find(member.id);
      if (!stays) continue;
      members.push_back(member);
      if (parts == relation_parts_.end()) continue;
      for (std::size_t k = 1; k < parts->second.size(); ++k) {
        members.push_back({member.kind, parts->second[k], member.role});
        changed = true;
      }
    }
    edit_.keep(relation.at);
    if (!changed) return;
    ++thinned_;
    OsmElement element(edit_.text_of(relation.at));
    element.set_members(members);
    remember(relation, text_of(relation.members), element);
    edit_.keep(relation.at, element.text());
  }

  // Those of lines and relations that stay, and those inside that nothing refers to.
  void write_nodes() {
    for (std::size_t i = 0; i < document_.nodes.size(); ++i) {
      const lanelet2::Node& node = document_.nodes[i];
      const bool stays =
          node_stays_[i] || (!index_.is_of_way()[i] && node.placed &&
                             region_.contains(node.in_map.head<2>() + document_.origin_in_source));
      if (stays) edit_.keep(node.at);
    }
  }

  const Document& document_;
  const LaneletIndex& index_;
  const Region& region_;
  const ClipOptions& options_;
  OsmPart edit_;
  const NodeText nodes_;
  std::int64_t next_id_;
  std::vector<std::vector<LineSpan>> spans_;  // of each way
  std::vector<WayRole> role_;
  std::vector<bool> forced_, node_stays_, relation_stays_, way_stays_;
  std::vector<const LaneletWays*> strips_;                  // lanelets that the region touches
  std::map<std::uint32_t, std::vector<std::int64_t>> ids_;  // of the parts of each way
  std::map<std::int64_t, std::vector<std::int64_t>> relation_parts_;  // of each lanelet
  std::size_t cut_ = 0, parts_ = 0, uncut_ = 0, thinned_ = 0;
};

}  // namespace

Clipper lanelet2_clipper(std::string bytes, const std::string& name, const ClipOptions& options) {
  const auto document =
      std::make_shared<const Document>(lanelet2::read_document(std::move(bytes), name));
  const auto index = std::make_shared<const LaneletIndex>(*document);
  const auto layout = std::make_shared<const OsmLayout>(*document);
  return [document, index, layout, options](const Region& region) {
    Edited result;
    LaneletClipper(*document, *index, *layout, region, options).run(result);
    return result;
  };
}

}  // namespace roadbed::map::edit::clipping
