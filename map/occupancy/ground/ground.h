#pragma once

#include <Eigen/Core>
#include <vector>

#include "roadbed/geometry/index/point_index.h"

namespace roadbed::map::inline occupancy::inline ground {

/// A place of the ground, and the plane that touches it there.
struct GroundPlace {
  Eigen::Vector2d in_source{0, 0};
  double z_m = 0.0;
  Eigen::Vector2d slope{0, 0};  ///< rise per metre along x and y
};

/// The ground under a drive: around each of many places it is the plane of that place. Immutable.
///
///      ──╲           ╱──     heights of a body are above the ground under each column, so
///         ╲__     __╱        that the band that it takes follows the road
///            ╲___╱
class Ground {
 public:
  /// @throws std::invalid_argument if there is no place, or a number is not finite.
  explicit Ground(std::vector<GroundPlace> places);

  /// Height at a point: that of the nearest place's plane. O(log N).
  double height_m(const Eigen::Vector2d& in_source) const;

  /// At the places.
  double lowest_m() const { return lowest_m_; }
  double highest_m() const { return highest_m_; }

  /// Whether all of it is one horizontal plane.
  bool is_level() const;

  const std::vector<GroundPlace>& places() const { return places_; }

 private:
  std::vector<GroundPlace> places_;
  geometry::PointIndex index_;
  double lowest_m_, highest_m_;
};

}  // namespace roadbed::map::occupancy::ground
