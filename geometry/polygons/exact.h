#pragma once

#include <vector>

#include "roadbed/geometry/polygons/ring.h"

// What of polygons needs exact arithmetic. exact.cpp is the only file that sees CGAL.

namespace roadbed::geometry::inline polygons::exact {

/// Sign of the turn a → b → c: 1 to the left, −1 to the right, 0 if they are on one line.
int turn(const Eigen::Vector2d& a, const Eigen::Vector2d& b, const Eigen::Vector2d& c);

/// Whether no two edges meet except neighbours at their shared point; points are finite.
bool has_simple_edges(const Ring& ring);

/// Boundaries of one connected part of a region, the region to their left.
using Boundaries = std::vector<Ring>;

/// The region where the winding numbers of all rings together are not zero, part by part; parts
/// that meet only at points are apart. Corners where edges cross are exact, then rounded to
/// doubles. A boundary may pass a point more than once. Points are finite, no edge has length 0.
std::vector<Boundaries> wound_region(const std::vector<Ring>& rings);

}  // namespace roadbed::geometry::polygons::exact
