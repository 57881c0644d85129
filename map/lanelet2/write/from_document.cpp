#include "roadbed/map/lanelet2/write/from_document.h"

#include <algorithm>
#include <array>
#include <utility>

namespace roadbed::map::lanelet2 {
namespace {

constexpr std::uint32_t kLeftOut = 0xffffffff;

// What osm_text() says of a node itself.
bool is_of_place(std::string_view key) {
  constexpr std::array<std::string_view, 4> keys = {"local_x", "local_y", "ele", "mgrs_code"};
  return std::ranges::count(keys, key) > 0;
}

std::int64_t id_beyond(const Document& document) {
  std::int64_t largest = 0;
  const auto see = [&](const auto& elements) {
    for (const auto& element : elements) {
      if (element.id <= kLargestKeptId) largest = std::max(largest, element.id);
    }
  };
  see(document.nodes);
  see(document.ways);
  see(document.relations);
  return largest + 1;
}

class Copier {
 public:
  Copier(const Document& document, const BuiltLanes& built)
      : document_(document), built_(built), made_(id_beyond(document)) {}

  LaneletMap copy() {
    copy_nodes();
    copy_ways();
    copy_relations();
    for (std::size_t lane = 0; lane < built_.lanes.size(); ++lane) add_lane(lane);
    return std::move(made_);
  }

 private:
  void add_lane(std::size_t lane) {
    const std::uint32_t relation = relations_[built_.relations[lane]];
    const Border left = in_copy(built_.left[lane]), right = in_copy(built_.right[lane]);
    const bool is_whole = relation != kLeftOut && left.way != kLeftOut && right.way != kLeftOut;
    made_.lanelets.push_back(is_whole ? std::optional(relation) : std::nullopt);
    made_.borders.push_back({left, right});
  }

  void copy_nodes() {
    nodes_.resize(document_.nodes.size(), kLeftOut);
    for (std::uint32_t i = 0; i < document_.nodes.size(); ++i) {
      const Node& node = document_.nodes[i];
      if (!node.placed || document_.node_index.find(node.id) != i) continue;
      Attributes tags = document_.tags_of(node.at);
      std::erase_if(tags, [](const auto& tag) { return is_of_place(tag.first); });
      nodes_[i] = static_cast<std::uint32_t>(made_.osm.nodes.size());
      made_.osm.nodes.push_back({node.id, node.in_map, std::move(tags)});
    }
  }

  void copy_ways() {
    ways_.resize(document_.ways.size(), kLeftOut);
    for (std::uint32_t i = 0; i < document_.ways.size(); ++i) {
      const Way& way = document_.ways[i];
      if (document_.way_index.find(way.id) != i) continue;
      std::vector<std::uint32_t> nodes;
      for (const std::uint32_t node : way.nodes) {
        if (nodes_[node] != kLeftOut) nodes.push_back(nodes_[node]);
      }
      ways_[i] = made_.osm.add_way(std::move(nodes), attributes_of(way.tags), way.id);
    }
  }

  // All of them first, as they may name each other in any order.
  void copy_relations() {
    relations_.resize(document_.relations.size(), kLeftOut);
    for (std::uint32_t i = 0; i < document_.relations.size(); ++i) {
      const Relation& relation = document_.relations[i];
      if (document_.relation_index.find(relation.id) != i) continue;
      relations_[i] = made_.osm.add_relation({}, attributes_of(relation.tags), relation.id);
    }
    for (std::uint32_t i = 0; i < document_.relations.size(); ++i) {
      if (relations_[i] == kLeftOut) continue;
      for (const Member& member : document_.relations[i].members) {
        const std::uint32_t place = place_of(member);
        if (place == kLeftOut) continue;
        made_.osm.relations[relations_[i]].members.push_back(
            {member.kind, place, std::string(member.role)});
      }
    }
  }

  std::uint32_t place_of(const Member& member) const {
    const bool is_node = member.kind == MemberKind::node, is_way = member.kind == MemberKind::way;
    const IdIndex& index = is_node  ? document_.node_index
                           : is_way ? document_.way_index
                                    : document_.relation_index;
    const auto& places = is_node ? nodes_ : is_way ? ways_ : relations_;
    const auto found = index.find(member.id);
    return found ? places[*found] : kLeftOut;
  }

  Border in_copy(const Border& border) const { return {ways_[border.way], border.reversed}; }

  const Document& document_;
  const BuiltLanes& built_;
  LaneletMap made_;
  std::vector<std::uint32_t> nodes_, ways_, relations_;  // places in the copy
};

}  // namespace

LaneletMap lanelet_map_of(const Document& document, const BuiltLanes& built) {
  return Copier(document, built).copy();
}

}  // namespace roadbed::map::lanelet2
