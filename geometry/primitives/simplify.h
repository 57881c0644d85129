#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

namespace roadbed::geometry::inline primitives {

/// A line through some of its points that keeps within `tolerance_m` of all of them; both ends
/// stay. Douglas and Peucker 1973, doi:10.3138/FM57-6770-U75U-7727. O(N log N) for smooth lines.
/// @throws std::invalid_argument if the tolerance is negative or not finite.
std::vector<Eigen::Vector2d> simplify(std::span<const Eigen::Vector2d> points, double tolerance_m);

}  // namespace roadbed::geometry::primitives
