#pragma once

#include <Eigen/Core>
#include <functional>
#include <memory>
#include <vector>

#include "roadbed/map/lane.h"
#include "roadbed/map/road_map.h"

namespace roadbed::map {

/// Finds lanes near a point: an R-tree over short stretches of the lanes' centrelines, each box as
/// wide as its lane.
class LaneIndex {
 public:
  explicit LaneIndex(const std::vector<Lane>& lanes);
  ~LaneIndex();
  LaneIndex(LaneIndex&&) noexcept;
  LaneIndex& operator=(LaneIndex&&) noexcept;

  /// Every lane that passes the filter within `radius_m` of the point, in order of id.
  /// @param lanes  the lanes that the index was made of.
  std::vector<LaneMatch> near(const std::vector<Lane>& lanes, const Eigen::Vector2d& point_in_map,
                              double radius_m,
                              const std::function<bool(const Lane&)>& filter) const;

 private:
  struct Tree;
  std::unique_ptr<const Tree> tree_;
};

}  // namespace roadbed::map
