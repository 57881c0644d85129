#include "roadbed/map/edit/clipping/lanelet_index.h"

#include <algorithm>

#include "roadbed/map/edit/osm_edit.h"
#include "roadbed/map/lanelet2/centreline.h"

namespace roadbed::map::inline edit::inline clipping {
namespace {

using Eigen::Vector2d;
using lanelet2::Member;
using lanelet2::MemberKind;
using lanelet2::Relation;
using lanelet2::Way;

std::vector<std::uint32_t> near(const geometry::BoxTree& tree, const Region& region) {
  std::vector<std::uint32_t> found;
  if (tree.size() == 0) return found;
  tree.visit(region.bounds(),
             [&](std::size_t i) { found.push_back(static_cast<std::uint32_t>(i)); });
  std::ranges::sort(found);
  return found;
}

}  // namespace

LaneletIndex::LaneletIndex(const lanelet2::Document& document)
    : document_(document),
      roles_(document.ways.size(), WayRole::alone),
      is_of_way_(document.nodes.size(), false),
      free_id_(edit::free_id(document)) {
  std::vector<geometry::Box> boxes, lanelet_boxes;
  for (std::uint32_t i = 0; i < document.ways.size(); ++i) {
    const Way& way = document.ways[i];
    for (const std::uint32_t node : way.nodes) is_of_way_[node] = true;
    boxes.push_back(geometry::box_around(line_of(i)));
    const bool closed = way.nodes.size() > 2 && way.nodes.front() == way.nodes.back();
    if (closed || way.references != way.nodes.size()) roles_[i] = WayRole::fixed;
  }
  for (std::uint32_t i = 0; i < document.relations.size(); ++i) {
    if (document.relations[i].type == "lanelet") add_lanelet(i);
  }
  for (const LaneletWays& lanelet : lanelets_) {
    lanelet_boxes.push_back(boxes[lanelet.ways[0]].merged(boxes[lanelet.ways[1]]));
  }
  if (!boxes.empty()) way_tree_ = geometry::BoxTree(boxes);
  if (!lanelet_boxes.empty()) lanelet_tree_ = geometry::BoxTree(lanelet_boxes);
}

std::vector<Vector2d> LaneletIndex::line_of(std::uint32_t way) const {
  std::vector<Vector2d> line;
  line.reserve(document_.ways[way].nodes.size());
  for (const std::uint32_t node : document_.ways[way].nodes) {
    line.push_back(document_.nodes[node].in_map.head<2>() + document_.origin_in_source);
  }
  return line;
}

std::vector<std::uint32_t> LaneletIndex::ways_near(const Region& region) const {
  return near(way_tree_, region);
}

std::vector<std::uint32_t> LaneletIndex::lanelets_near(const Region& region) const {
  return near(lanelet_tree_, region);
}

std::optional<std::uint32_t> LaneletIndex::way_in_role(const Relation& relation,
                                                       std::string_view role) const {
  for (const Member& member : relation.members) {
    if (member.role != role || member.kind != MemberKind::way) continue;
    const auto way = document_.way_index.find(member.id);
    if (way && document_.ways[*way].nodes.size() >= 2) return way;
  }
  return {};
}

void LaneletIndex::add_lanelet(std::uint32_t index) {
  const Relation& relation = document_.relations[index];
  const auto left = way_in_role(relation, "left"), right = way_in_role(relation, "right");
  if (!left || !right) {
    ++unusable_;
    return;
  }
  for (const std::uint32_t way : {*left, *right}) {
    if (roles_[way] == WayRole::alone) roles_[way] = WayRole::border;
  }
  const auto alignment = lanelet2::align(document_.points(document_.ways[*left]),
                                         document_.points(document_.ways[*right]));
  LaneletWays lanelet{index, {*left, *right}, {alignment.left_reversed, alignment.right_reversed}};
  if (const auto centre = way_in_role(relation, "centerline")) {
    lanelet.ways.push_back(*centre);
    lanelet.reversed.push_back(runs_against(*centre, lanelet));
  }
  lanelets_.push_back(std::move(lanelet));
}

bool LaneletIndex::runs_against(std::uint32_t centre, const LaneletWays& lanelet) const {
  const auto start_of = [&](std::size_t i) {
    const std::vector<Vector2d> line = line_of(lanelet.ways[i]);
    return lanelet.reversed[i] ? line.back() : line.front();
  };
  const std::vector<Vector2d> line = line_of(centre);
  const Vector2d start = 0.5 * (start_of(0) + start_of(1));
  return (line.back() - start).squaredNorm() < (line.front() - start).squaredNorm();
}

}  // namespace roadbed::map::edit::clipping
