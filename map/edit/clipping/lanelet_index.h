#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <string_view>
#include <vector>

#include "roadbed/geometry/index/box_tree.h"
#include "roadbed/map/edit/clipping/region.h"
#include "roadbed/map/lanelet2/document.h"

namespace roadbed::map::inline edit::inline clipping {

/// What a way is to lanelets: `border` of one, `fixed` where it is not cut.
enum class WayRole { alone, border, fixed };

/// A lanelet with two usable borders: indices of its ways, left, right, and the centreline if it
/// has one, and whether each runs against the lanelet.
struct LaneletWays {
  std::uint32_t relation = 0;
  std::vector<std::uint32_t> ways;
  std::vector<bool> reversed;
};

/// What a Lanelet2 document says of its lanelets whichever region it is clipped to, and which of
/// its ways and lanelets may be near one.
class LaneletIndex {
 public:
  /// @param document  outlives it.
  explicit LaneletIndex(const lanelet2::Document& document);

  /// Points in the source's coordinates.
  std::vector<Eigen::Vector2d> line_of(std::uint32_t way) const;

  /// All that may have a point in the region, in the order of the file.
  std::vector<std::uint32_t> ways_near(const Region& region) const;
  std::vector<std::uint32_t> lanelets_near(const Region& region) const;

  const std::vector<LaneletWays>& lanelets() const { return lanelets_; }
  std::size_t unusable() const { return unusable_; }  ///< lanelets without two usable borders

  /// Of each way; a centreline counts as alone.
  const std::vector<WayRole>& roles() const { return roles_; }

  /// Of each node: whether a way goes through it.
  const std::vector<bool>& is_of_way() const { return is_of_way_; }

  /// The number after the greatest id.
  std::int64_t free_id() const { return free_id_; }

 private:
  void add_lanelet(std::uint32_t relation);
  std::optional<std::uint32_t> way_in_role(const lanelet2::Relation& relation,
                                           std::string_view role) const;
  bool runs_against(std::uint32_t centre, const LaneletWays& lanelet) const;

  const lanelet2::Document& document_;
  std::vector<WayRole> roles_;
  std::vector<bool> is_of_way_;
  std::vector<LaneletWays> lanelets_;
  std::size_t unusable_ = 0;
  std::int64_t free_id_;
  geometry::BoxTree way_tree_, lanelet_tree_;
};

}  // namespace roadbed::map::edit::clipping
