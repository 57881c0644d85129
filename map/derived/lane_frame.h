#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "roadbed/map/model/road_map.h"

namespace roadbed::map::inline derived {

/// Between points of the map and places (s, d) beside a lane's centreline, in both directions.
///
/// The straight pieces of a sampled centreline leave wedges at their corners that no normal
/// reaches. So the direction t(s) that d is measured across turns steadily along each piece, from
/// the curve's tangent at one vertex to that at the next:
///
///     point(s, d) = c(s) + d n(s),   n(s) the unit normal to the left of t(s)          (1)
///     s(point):   (point − c(s)) · t(s) = 0                                            (2)
///
/// Both are each other's inverse where |d| is less than the centreline's radius of curvature.
/// A frame refers to its lane, which must outlive it.
class LaneFrame {
 public:
  explicit LaneFrame(const Lane& lane);

  /// @param s_m  clamped to the lane. O(log N).
  Eigen::Vector2d to_map(double s_m, double d_m) const;

  /// Direction of the lane at a station [rad].
  double heading_rad(double s_m) const;

  /// The place of a point that is beside the lane; none before its start and beyond its end. Of
  /// several places, on a bend whose centre is near, that with the least |d|. O(N).
  std::optional<LanePlace> to_lane(const Eigen::Vector2d& point_in_map) const;

 private:
  Eigen::Vector2d direction(double s_m) const;
  double ahead_m(const Eigen::Vector2d& point, double s_m) const;
  double station_beside_m(const Eigen::Vector2d& point, double from_m, double to_m) const;

  const Lane* lane_;
  std::vector<double> station_m_;          ///< of the corners
  std::vector<Eigen::Vector2d> tangents_;  ///< unit vectors, one per corner
};

/// A place in the terms of OpenDRIVE: `s` along the road's reference line, `t` to its left.
struct RoadPlace {
  RoadId road;
  double s_m = 0.0;
  double t_m = 0.0;
};

/// Where a point beside a lane is on the lane's road, within the lane's own range of s; none for
/// lanes of no road. O(points of the reference line).
std::optional<RoadPlace> road_place(const RoadMap& road_map, LaneId lane,
                                    const Eigen::Vector2d& point_in_map);

}  // namespace roadbed::map::derived
