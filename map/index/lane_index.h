#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "roadbed/geometry/index/box_tree.h"
#include "roadbed/map/elements/lane_match.h"
#include "roadbed/map/index/lane_index_data.h"

namespace roadbed::map::inline index {

/// Finds lanes near a point or in a box: a packed Hilbert R-tree [Kamel 1993,
/// doi:10.1145/170088.170403] of pieces of lanes, on flat arrays, so that it is used where it lies
/// in a compiled map. Lanes without a polygon are not found. Safe to use from several threads.
/// All questions throw InputError if the file that holds the index is damaged.
class LaneIndex {
 public:
  LaneIndex() = default;
  explicit LaneIndex(const LazyList<Lane>& lanes) : LaneIndex(lane_index::build(lanes)) {}

  /// @throws InputError if the arrays do not fit each other.
  explicit LaneIndex(lane_index::Data data);

  /// Lanes within the radius, nearest first (inside: by |d|), ties by id. A point that is not
  /// finite has none.
  std::vector<LaneMatch> near(const Eigen::Vector2d& point_in_map, const LaneQuery& query) const;

  /// Whether there are any, which needs no place along them.
  bool is_any_near(const Eigen::Vector2d& point_in_map, const LaneQuery& query) const;

  /// The lanes near many points, one list each; taken in an order in which points near each other
  /// follow each other, so that caches stay warm.
  LaneMatches near(std::span<const Eigen::Vector2d> points_in_map, const LaneQuery& query) const;

  /// Lanes of which a piece of at most some eight segments has a box that meets this one: all that
  /// are in it and few that are not. In order of id.
  std::vector<LaneId> in_box(const Eigen::Vector2d& low_in_map, const Eigen::Vector2d& high_in_map,
                             const LaneTypes& types) const;

  /// Around all lanes, of any type, with coordinates rounded outwards to float; empty without any.
  geometry::Box box() const;

  const lane_index::Data& data() const { return data_; }

 private:
  lane_index::Data data_;
  std::vector<std::uint64_t> level_starts_;
};

}  // namespace roadbed::map::index
