#pragma once

#include <Eigen/Core>
#include <vector>

#include "roadbed/map/elements/lane.h"

namespace roadbed::map::inline elements {

/// A line of a lane, of points with their height.
/// @param station_m  one per point, or empty: set later.
LaneLine lane_line(const std::vector<Eigen::Vector3d>& in_map, std::vector<double> station_m);

/// Gives a lane its lines and polygon. Places at the same fraction of the borders' lengths in plan
/// are opposite each other; the centreline is halfway, with a vertex for each of the borders'.
///
///     left   ●────●─────────●
///     centre ●────●───●─────●      at fractions 0, 0.3, 0.5 and 1
///     right  ●────────●─────●
///
/// @param left_in_map, right_in_map  in driving direction, two points or more each.
void set_borders(const std::vector<Eigen::Vector3d>& left_in_map,
                 const std::vector<Eigen::Vector3d>& right_in_map, Lane& lane);

/// Gives two borders of different numbers of points the same number: each gets a point where the
/// other has one, by the fraction of its length in plan.
void pair_points(std::vector<Eigen::Vector3d>& left_in_map,
                 std::vector<Eigen::Vector3d>& right_in_map);

/// The centreline of borders of equally many points.
std::vector<Eigen::Vector3d> points_halfway(const std::vector<Eigen::Vector3d>& left_in_map,
                                            const std::vector<Eigen::Vector3d>& right_in_map);

/// The same as set_borders() of three lines of equally many points each: those of one index are
/// opposite each other.
void set_lines(const std::vector<Eigen::Vector3d>& left_in_map,
               const std::vector<Eigen::Vector3d>& centre_in_map,
               const std::vector<Eigen::Vector3d>& right_in_map, Lane& lane);

/// Whether the left border lies to the right of the right one.
bool has_swapped_borders(const Lane& lane);

/// Where a map's local coordinates begin: (0, 0), or a whole kilometre near a point that is more
/// than 20 km out.
Eigen::Vector2d origin_near(const Eigen::Vector2d& in_source);

}  // namespace roadbed::map::elements
