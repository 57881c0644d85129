#pragma once

#include <Eigen/Core>
#include <array>

namespace roadbed::tests {

/// Four corners in order, either way round.
using Quad = std::array<Eigen::Vector2d, 4>;

Quad box_quad(const Eigen::Vector2d& least, const Eigen::Vector2d& most);

/// Distance between two convex quadrilaterals, 0 if they meet: every edge against every edge, and
/// a corner of each inside the other. Slow and plain: an oracle.
double quad_distance(const Quad& a, const Quad& b);

}  // namespace roadbed::tests
