#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <set>

#include "roadbed/map/lanelet2/rules/source.h"
#include "roadbed/map/repair/near_ends.h"
#include "roadbed/map/repair/proposals.h"

namespace roadbed::map::inline repair {
namespace {

using lanelet2::Member;
using lanelet2::MemberKind;
using lanelet2::rules::Edge;
using lanelet2::rules::Lanelet;

constexpr double kSameLevel_m = 1.0;  // nodes of two roads, one above the other, are farther apart

/// Where the elements of a kind that stand in another one begin: "nd" of a way.
std::vector<XmlElementText> children(std::string_view text, std::size_t at, std::string_view kind) {
  std::vector<XmlElementText> found;
  const XmlElementText element(text, at);
  const std::string tag = "<" + std::string(kind);
  const std::size_t end = element.begin() + element.whole().size();
  for (std::size_t i = text.find(tag, element.begin() + 1); i < end; i = text.find(tag, i + 1)) {
    const char next = text[i + tag.size()];
    if (next == ' ' || next == '\t' || next == '\n' || next == '\r')
      found.emplace_back(text, i + 1);
  }
  return found;
}

class Lanelet2Proposer {
 public:
  Lanelet2Proposer(const std::string& bytes, const std::string& name, const RepairOptions& options)
      : options_(options),
        document_(lanelet2::read_document(bytes, name)),
        built_(lanelet2::build_lanes(document_)),
        source_(document_, built_) {}

  std::vector<Repair> propose() {
    merge_nodes();
    swap_borders();
    give_types();
    return std::move(repairs_);
  }

 private:
  void add(std::string rule, std::string element, std::size_t at, std::string what,
           std::vector<TextEdit> edits, double moved_m = 0.0) {
    repairs_.push_back({std::move(rule), std::move(element), document_.line_of(at), std::move(what),
                        moved_m, std::move(edits)});
  }

  /// Of two nodes the one that stands first in the file stays where it is.
  void merge_nodes() {
    NearPoints ends(options_.tolerance_m);
    std::vector<std::uint32_t> places;
    for (const Lanelet& lanelet : source_.lanelets) {
      if (!lanelet.start) continue;
      for (const Edge& edge : {*lanelet.start, *lanelet.end}) {
        places.push_back(edge.left);
        places.push_back(edge.right);
      }
    }
    std::sort(places.begin(), places.end());
    places.erase(std::unique(places.begin(), places.end()), places.end());
    for (const std::uint32_t place : places) ends.add(node(place).in_map.head<2>(), place);
    std::set<std::size_t> merged;
    for (const std::uint32_t place : places) {
      ends.visit(node(place).in_map.head<2>(), [&](std::size_t other) {
        if (other <= place || merged.contains(other) || merged.contains(place)) return;
        if (std::abs(node(place).in_map.z() - node(other).in_map.z()) > kSameLevel_m) return;
        if (share_a_way(place, static_cast<std::uint32_t>(other))) return;
        merged.insert(place);
        merged.insert(other);
        merge(place, static_cast<std::uint32_t>(other));
      });
    }
  }

  const lanelet2::Node& node(std::size_t place) const { return document_.nodes[place]; }

  /// Two nodes of one line are two places of it.
  bool share_a_way(std::uint32_t a, std::uint32_t b) {
    const auto& of_a = ways_of(a);
    return std::ranges::any_of(ways_of(b), [&](const lanelet2::Way* way) {
      return std::ranges::find(of_a, way) != of_a.end();
    });
  }

  const std::vector<const lanelet2::Way*>& ways_of(std::uint32_t place) {
    if (ways_of_node_.empty()) {
      for (const lanelet2::Way& way : document_.ways) {
        for (const std::uint32_t node : way.nodes) ways_of_node_[node].push_back(&way);
      }
    }
    return ways_of_node_[place];
  }

  void merge(std::uint32_t kept, std::uint32_t gone) {
    const std::string to = std::to_string(node(kept).id);
    std::vector<TextEdit> edits;
    for (const lanelet2::Way* way : ways_of(gone)) {
      const auto references = children(document_.text, way->at, "nd");
      if (references.size() != way->nodes.size()) return;  // some of them name nothing
      for (std::size_t i = 0; i < references.size(); ++i) {
        if (way->nodes[i] == gone) edits.push_back(references[i].with_attribute("ref", to));
      }
    }
    const double apart_m = (node(kept).in_map - node(gone).in_map).head<2>().norm();
    add("lanelet2.unshared-border", fmt::format("node {}", node(gone).id), node(gone).at,
        fmt::format("borders that ended in it now end in node {}, {:.3f} m away", to, apart_m),
        std::move(edits), apart_m);
  }

  void swap_borders() {
    for (const Lanelet* lanelet : lanelet2::rules::lanelets_with_swapped_borders(source_)) {
      swap_roles(*lanelet);
    }
  }

  void swap_roles(const Lanelet& lanelet) {
    const auto members = children(document_.text, lanelet.relation.at, "member");
    if (members.size() != lanelet.relation.members.size()) return;
    std::vector<TextEdit> edits;
    for (std::size_t i = 0; i < members.size(); ++i) {
      const std::string_view role = lanelet.relation.members[i].role;
      if (role == "left") edits.push_back(members[i].with_attribute("role", "right"));
      if (role == "right") edits.push_back(members[i].with_attribute("role", "left"));
    }
    add("lanelet2.swapped-borders", fmt::format("lane {}", lanelet.relation.id),
        lanelet.relation.at, "its left and right border have changed their roles",
        std::move(edits));
  }

  void give_types() {
    std::set<std::uint32_t> seen;
    for (const Lanelet& lanelet : source_.lanelets) {
      for (const Member& member : lanelet.relation.members) {
        if (member.kind != MemberKind::way) continue;
        if (member.role != "left" && member.role != "right") continue;
        const auto place = document_.way_index.find(member.id);
        if (!place || !seen.insert(*place).second) continue;
        const lanelet2::Way& way = document_.ways[*place];
        if (!way.type.empty()) continue;
        add("lanelet2.border-without-type", fmt::format("way {}", way.id), way.at,
            "is now of type virtual: nobody may cross it, as before",
            {XmlElementText(document_.text, way.at + 1)
                 .with_last_child(R"(<tag k="type" v="virtual"/>)")});
      }
    }
  }

  const RepairOptions& options_;
  lanelet2::Document document_;
  lanelet2::BuiltLanes built_;
  lanelet2::rules::Source source_;
  std::map<std::uint32_t, std::vector<const lanelet2::Way*>> ways_of_node_;
  std::vector<Repair> repairs_;
};

}  // namespace

std::vector<Repair> propose_lanelet2(const std::string& bytes, const std::string& name,
                                     const RepairOptions& options) {
  return Lanelet2Proposer(bytes, name, options).propose();
}

}  // namespace roadbed::map::repair
