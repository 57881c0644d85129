#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <functional>
#include <vector>

#include "roadbed/map/model/road_map.h"

namespace roadbed::map::lanelet2 {

/// Lanes whose borders are shared objects, as formats with topology by identity need them:
/// neighbours have one line between them, a lane's lines begin with the points that those of the
/// lane before end with.
///
///       ●───────────●───────────●
///       │   lane 1  │   lane 2  │        ● shared point
///       ●───────────●───────────●        ──── shared line
///       │   lane 3  │   lane 4  │
///       ●───────────●───────────●
struct SharedBorders {
  /// A line of a lane, left or right: which of `lines`, and whether the lane runs against it.
  struct Side {
    std::uint32_t line = 0;
    bool reversed = false;
  };
  std::vector<Eigen::Vector3d> points;            ///< in map, z too [m]
  std::vector<std::vector<std::uint32_t>> lines;  ///< places in `points`
  std::vector<std::array<Side, 2>> lanes;         ///< left and right, by LaneId

  double largest_move_m = 0.0;     ///< of an end that was joined to another one
  double largest_step_m = 0.0;     ///< from a joint to the end that a line keeps behind it
  std::size_t lost_links = 0;      ///< successors whose ends are too far apart, or cannot be joined
  std::size_t unwanted_links = 0;  ///< lanes that now follow each other and did not before
};

struct SharingOptions {
  double same_line_m = 0.01;  ///< lines of neighbours that are nowhere farther apart are one
  double join_m = 0.5;        ///< ends of linked lanes that are no farther apart are joined
  /// Ends that are farther apart, up to this, are joined by a step if it leads forward or aside, as
  /// where a lane's width jumps:
  ///
  ///     ────────●
  ///             │ step
  ///             ●────────
  double step_m = 5.0;
  double move_m = 2.0;  ///< and where it would lead back, they are joined up to this
  std::function<bool(const Lane&)> counts = {};  ///< lanes whose links are counted; none: all
};

/// Lines are joined where they are equal, or where neighbours' lines nearly are; ends only where a
/// link says so, since that two lanes touch does not mean that one follows the other.
SharedBorders share_borders(const RoadMap& road_map, const SharingOptions& options = {});

}  // namespace roadbed::map::lanelet2
