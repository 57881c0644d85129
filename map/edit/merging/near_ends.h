#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

#include "roadbed/geometry/index/box_tree.h"
#include "roadbed/geometry/primitives/work_limit.h"

namespace roadbed::map::inline edit::inline merging {

/// Ends of roads or lanelets, for those near a place. Where n end in one place there are n² pairs
/// of them: what is looked at is counted.
class NearEnds {
 public:
  NearEnds(const std::vector<Eigen::Vector2d>& ends, double tolerance_m);

  /// Indices of those at most the tolerance away along each axis, in order.
  /// @throws InputError if more of them lie on each other than maps of that size may have.
  std::vector<std::size_t> around(const Eigen::Vector2d& place);

  /// Counts a pair that meets, and is said.
  /// @throws InputError as above.
  void add_pair();

 private:
  void spend(std::size_t steps);

  std::size_t size_;
  double tolerance_m_;
  geometry::BoxTree tree_;
  geometry::WorkBudget steps_;
};

}  // namespace roadbed::map::edit::merging
