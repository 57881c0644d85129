#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <string_view>
#include <utility>
#include <vector>

#include "roadbed/geometry/index/box_tree.h"
#include "roadbed/geometry/polygons/ring.h"
#include "roadbed/geometry/primitives/work_limit.h"
#include "roadbed/map/lanelet2/build_map.h"
#include "roadbed/map/lanelet2/rules/source.h"

namespace roadbed::map::lanelet2::autoware {

/// The ground of a lanelet, in driving direction.
struct Surface {
  Border left_border, right_border;
  std::vector<Eigen::Vector3d> left, right;  ///< in map [m], two points or more each
  geometry::Ring ring;                       ///< left, then right back to the start
  geometry::Box box;
  double least_z_m = 0.0, greatest_z_m = 0.0;
  double area_m2 = 0.0;
};

/// A lanelet with what Autoware asks of it.
struct Lanelet {
  const rules::Lanelet* text = nullptr;
  std::vector<const Relation*> regulations;  ///< that it names and that are in the file
  std::optional<Surface> surface;            ///< none without two usable borders

  const Relation& relation() const { return text->relation; }
  std::int64_t id() const { return text->relation.id; }
  std::string_view subtype() const { return text->relation.subtype; }
  std::string_view tag(std::string_view key) const { return text->tag(key); }
};

/// Which side of a lanelet.
enum class Side { left, right };

/// A Lanelet2 document as Autoware's requirements look at it. Where nodes have no place, lanelets
/// have no surface and rules about shapes have nothing to say; all others do their work.
class VectorMap {
 public:
  /// @param source  kept by reference, with its document.
  VectorMap(const rules::Source& source, const BuiltLanes& built);

  const rules::Source& source() const { return *source_; }
  const Document& document() const { return source_->document; }
  const std::vector<Lanelet>& lanelets() const { return lanelets_; }
  const std::vector<const Relation*>& regulations() const { return source_->regulations; }

  /// By id; null if there is none.
  const Lanelet* lanelet(std::int64_t id) const;
  /// The same of a way.
  const Way* way(std::int64_t id) const;

  /// Lanelets that name a regulatory element.
  std::vector<const Lanelet*> users(const Relation& regulation) const;

  /// What a relation names with that role: ways that are areas (`area=yes`), all other ways, and
  /// lanelets. Members that are not in the file are left out.
  std::vector<const Way*> areas(const Relation& relation, std::string_view role) const;
  std::vector<const Way*> lines(const Relation& relation, std::string_view role) const;
  std::vector<const Lanelet*> lanelets(const Relation& relation, std::string_view role) const;

  /// Lanelets that begin, in driving direction, where this one ends, and the other way round; at
  /// most 64 of them.
  std::vector<const Lanelet*> following(const Lanelet& lanelet) const;
  std::vector<const Lanelet*> previous(const Lanelet& lanelet) const;

  /// Lanelets on the other side of a border way, in either direction; at most 64.
  std::vector<const Lanelet*> neighbours(const Lanelet& lanelet, Side side) const;

  /// Lanelets whose box meets this one, in order of the file; at most 64. None without budget.
  std::vector<const Lanelet*> near(const geometry::Box& box) const;

  /// Place of a node in the source's coordinates; none if it has none.
  std::optional<Eigen::Vector2d> place(const Node& node) const;
  std::optional<Eigen::Vector2d> place(const Way& way) const;
  std::optional<Eigen::Vector2d> place(const Lanelet& lanelet) const;
  /// Of a regulatory element: that of the first thing that it names.
  std::optional<Eigen::Vector2d> place(const Relation& regulation) const;

  /// Steps that rules may still take to compare shapes; shared by all of them.
  geometry::WorkBudget& budget() const { return budget_; }

 private:
  using Places = std::vector<std::uint32_t>;

  void add_surface(Lanelet& lanelet, const BuiltLanes& built, LaneId lane);
  void add_topology(std::uint32_t index);
  std::vector<const Lanelet*> all_of(const Places& places, const Lanelet& but) const;

  const rules::Source* source_;
  std::vector<Lanelet> lanelets_;
  std::map<std::int64_t, std::uint32_t> by_id_;
  std::map<const Relation*, Places> users_;
  std::map<rules::Edge, Places> starting_at_, ending_at_;
  std::map<std::uint32_t, std::array<Places, 4>> by_border_;  ///< way: see slot_of()
  std::vector<std::uint32_t> with_surface_;
  geometry::BoxTree boxes_;  ///< of those
  mutable geometry::WorkBudget budget_;
};

/// Whether a way is an area (a polygon of Lanelet2).
bool is_area(const Way& way);

/// Whether it has a tag, whatever its value.
bool has_tag(const Lanelet& lanelet, std::string_view key);

/// The regulatory elements of that subtype that a lanelet names.
std::vector<const Relation*> regulations_of(const Lanelet& lanelet, std::string_view subtype);

/// Whether vehicles may use it, as routing asks.
bool is_for_vehicles(const Lanelet& lanelet);

}  // namespace roadbed::map::lanelet2::autoware
