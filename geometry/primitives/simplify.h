#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

namespace roadbed::geometry::inline primitives {

/// How far a point is from the segment a … b [m]: as |foot − point| or as |(point − a) − (foot −
/// a)|. The two differ by rounding only, but that decides which of two points stays that are
/// equally far, as they are on an arc.
double distance_to_foot_m(const Eigen::Vector2d& a, const Eigen::Vector2d& b,
                          const Eigen::Vector2d& point);
double distance_from_start_m(const Eigen::Vector2d& a, const Eigen::Vector2d& b,
                             const Eigen::Vector2d& point);

/// A line through some of its points that keeps within `tolerance_m` of all of them; both ends
/// stay. Douglas and Peucker 1973, doi:10.3138/FM57-6770-U75U-7727. O(N log N) for smooth lines.
/// @throws std::invalid_argument if the tolerance is negative or not finite.
std::vector<Eigen::Vector2d> simplify(std::span<const Eigen::Vector2d> points, double tolerance_m,
                                      decltype(distance_to_foot_m)* distance = distance_to_foot_m);

}  // namespace roadbed::geometry::primitives
