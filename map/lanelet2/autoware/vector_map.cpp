#include "roadbed/map/lanelet2/autoware/vector_map.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "roadbed/geometry/polygons/polygon.h"
#include "roadbed/map/lanelet2/traffic_rules.h"

namespace roadbed::map::lanelet2::autoware {
namespace {

constexpr std::size_t kMost = 64;  // lanelets that are looked at from one place

std::vector<Eigen::Vector3d> points_of(const Document& document, const Border& border) {
  std::vector<Eigen::Vector3d> points = document.points(document.ways[border.way]);
  if (border.reversed) std::ranges::reverse(points);
  return points;
}

/// Lanelets on one side of a border way, seen in the way's direction: those that run along it have
/// it as their right border where they lie to its left, those against it as their left one.
std::size_t slot_of(Side side, bool reversed) {
  return (side == Side::left ? 0U : 2U) + (reversed ? 1U : 0U);
}

/// Slots of lanelets across the border from one that has it on that side.
std::array<std::size_t, 2> slots_across(Side side, bool reversed) {
  const Side other = side == Side::left ? Side::right : Side::left;
  return {slot_of(other, reversed), slot_of(side, !reversed)};
}

void add_few(std::vector<std::uint32_t>& places, std::uint32_t place) {
  if (places.size() < kMost) places.push_back(place);
}

std::size_t parts_of(const Document& document) {
  return document.way_nodes.size() + document.members.size() + document.nodes.size();
}

}  // namespace

VectorMap::VectorMap(const rules::Source& source, const BuiltLanes& built)
    : source_(&source), budget_(4 * geometry::most_steps(parts_of(source.document))) {
  const Document& text = document();
  std::vector<geometry::Box> boxes;
  lanelets_.reserve(source.lanelets.size());
  for (const rules::Lanelet& lanelet : source.lanelets) {
    const auto index = static_cast<std::uint32_t>(lanelets_.size());
    lanelets_.push_back({&lanelet, {}, {}});
    by_id_.emplace(lanelet.relation.id, index);
    for (const Member& member : lanelet.relation.members) {
      if (member.role != "regulatory_element") continue;
      const auto place = text.relation_index.find(member.id);
      if (!place || text.relations[*place].type != "regulatory_element") continue;
      lanelets_.back().regulations.push_back(&text.relations[*place]);
      Places& users = users_[&text.relations[*place]];
      if (users.empty() || users.back() != index) users.push_back(index);
    }
    const auto relation = static_cast<std::size_t>(&lanelet.relation - text.relations.data());
    if (relation >= built.lane_of_relation.size() || !built.lane_of_relation[relation]) continue;
    add_surface(lanelets_.back(), built, *built.lane_of_relation[relation]);
    add_topology(index);
    with_surface_.push_back(index);
    boxes.push_back(lanelets_.back().surface->box);
  }
  boxes_ = geometry::BoxTree(boxes);
}

void VectorMap::add_surface(Lanelet& lanelet, const BuiltLanes& built, LaneId lane) {
  Surface surface;
  surface.left_border = built.left[lane.index];
  surface.right_border = built.right[lane.index];
  surface.left = points_of(document(), surface.left_border);
  surface.right = points_of(document(), surface.right_border);
  surface.least_z_m = std::numeric_limits<double>::infinity();
  surface.greatest_z_m = -surface.least_z_m;
  const auto add = [&](const Eigen::Vector3d& point) {
    surface.ring.emplace_back(point.head<2>());
    surface.least_z_m = std::min(surface.least_z_m, point.z());
    surface.greatest_z_m = std::max(surface.greatest_z_m, point.z());
  };
  std::ranges::for_each(surface.left, add);
  std::for_each(surface.right.rbegin(), surface.right.rend(), add);
  surface.box = geometry::box_around(surface.ring);
  surface.area_m2 = std::abs(geometry::signed_area_m2(surface.ring));
  lanelet.surface = std::move(surface);
}

void VectorMap::add_topology(std::uint32_t index) {
  const Lanelet& lanelet = lanelets_[index];
  add_few(starting_at_[*lanelet.text->start], index);
  add_few(ending_at_[*lanelet.text->end], index);
  const Border left = lanelet.surface->left_border, right = lanelet.surface->right_border;
  add_few(by_border_[left.way][slot_of(Side::left, left.reversed)], index);
  add_few(by_border_[right.way][slot_of(Side::right, right.reversed)], index);
}

const Lanelet* VectorMap::lanelet(std::int64_t id) const {
  const auto found = by_id_.find(id);
  return found == by_id_.end() ? nullptr : &lanelets_[found->second];
}

const Way* VectorMap::way(std::int64_t id) const {
  const auto found = document().way_index.find(id);
  return found ? &document().ways[*found] : nullptr;
}

std::vector<const Lanelet*> VectorMap::users(const Relation& regulation) const {
  const auto found = users_.find(&regulation);
  std::vector<const Lanelet*> users;
  if (found == users_.end()) return users;
  for (const std::uint32_t place : found->second) users.push_back(&lanelets_[place]);
  return users;
}

std::vector<const Way*> VectorMap::areas(const Relation& relation, std::string_view role) const {
  std::vector<const Way*> ways;
  for (const Member& member : relation.members) {
    const Way* found =
        member.kind == MemberKind::way && member.role == role ? way(member.id) : nullptr;
    if (found != nullptr && is_area(*found)) ways.push_back(found);
  }
  return ways;
}

std::vector<const Way*> VectorMap::lines(const Relation& relation, std::string_view role) const {
  std::vector<const Way*> ways;
  for (const Member& member : relation.members) {
    const Way* found =
        member.kind == MemberKind::way && member.role == role ? way(member.id) : nullptr;
    if (found != nullptr && !is_area(*found)) ways.push_back(found);
  }
  return ways;
}

std::vector<const Lanelet*> VectorMap::lanelets(const Relation& relation,
                                                std::string_view role) const {
  std::vector<const Lanelet*> found;
  for (const Member& member : relation.members) {
    if (member.kind != MemberKind::relation || member.role != role) continue;
    if (const Lanelet* named = lanelet(member.id)) found.push_back(named);
  }
  return found;
}

std::vector<const Lanelet*> VectorMap::all_of(const Places& places, const Lanelet& but) const {
  std::vector<const Lanelet*> found;
  for (const std::uint32_t place : places) {
    if (&lanelets_[place] != &but) found.push_back(&lanelets_[place]);
  }
  return found;
}

std::vector<const Lanelet*> VectorMap::following(const Lanelet& lanelet) const {
  if (!lanelet.text->end) return {};
  const auto found = starting_at_.find(*lanelet.text->end);
  return found == starting_at_.end() ? std::vector<const Lanelet*>()
                                     : all_of(found->second, lanelet);
}

std::vector<const Lanelet*> VectorMap::previous(const Lanelet& lanelet) const {
  if (!lanelet.text->start) return {};
  const auto found = ending_at_.find(*lanelet.text->start);
  return found == ending_at_.end() ? std::vector<const Lanelet*>() : all_of(found->second, lanelet);
}

std::vector<const Lanelet*> VectorMap::neighbours(const Lanelet& lanelet, Side side) const {
  std::vector<const Lanelet*> found;
  if (!lanelet.surface) return found;
  const Border border =
      side == Side::left ? lanelet.surface->left_border : lanelet.surface->right_border;
  for (const std::size_t slot : slots_across(side, border.reversed)) {
    const auto more = all_of(by_border_.at(border.way)[slot], lanelet);
    found.insert(found.end(), more.begin(), more.end());
  }
  return found;
}

std::vector<const Lanelet*> VectorMap::near(const geometry::Box& box) const {
  Places places;
  if (boxes_.size() == 0 || budget_.is_spent()) return {};
  std::size_t met = 0;
  boxes_.visit(box, [&](std::size_t index) {
    ++met;
    add_few(places, with_surface_[index]);
  });
  budget_.spend(met);
  std::ranges::sort(places);
  std::vector<const Lanelet*> found;
  for (const std::uint32_t place : places) found.push_back(&lanelets_[place]);
  return found;
}

std::optional<Eigen::Vector2d> VectorMap::place(const Node& node) const {
  if (!node.placed) return {};
  return node.in_map.head<2>() + document().origin_in_source;
}

std::optional<Eigen::Vector2d> VectorMap::place(const Way& way) const {
  if (way.nodes.empty()) return {};
  return place(document().nodes[way.nodes.front()]);
}

std::optional<Eigen::Vector2d> VectorMap::place(const Lanelet& lanelet) const {
  if (!lanelet.text->start) return {};
  return place(document().nodes[lanelet.text->start->left]);
}

std::optional<Eigen::Vector2d> VectorMap::place(const Relation& regulation) const {
  for (const Member& member : regulation.members) {
    std::optional<Eigen::Vector2d> found;
    if (member.kind == MemberKind::way) {
      if (const Way* named = way(member.id)) found = place(*named);
    } else if (member.kind == MemberKind::relation) {
      if (const Lanelet* named = lanelet(member.id)) found = place(*named);
    }
    if (found) return found;
  }
  return {};
}

bool is_area(const Way& way) { return truth_of(value_of(way.tags, "area")).value_or(false); }

bool has_tag(const Lanelet& lanelet, std::string_view key) {
  return std::ranges::any_of(lanelet.relation().tags,
                             [&](const Tag& tag) { return tag.first == key; });
}

std::vector<const Relation*> regulations_of(const Lanelet& lanelet, std::string_view subtype) {
  std::vector<const Relation*> found;
  for (const Relation* regulation : lanelet.regulations) {
    if (regulation->subtype == subtype) found.push_back(regulation);
  }
  return found;
}

bool is_for_vehicles(const Lanelet& lanelet) {
  const Participants users = participants(lanelet.relation().tags);
  return (users.bits() & Participants::vehicles().bits()) != 0;
}

}  // namespace roadbed::map::lanelet2::autoware
