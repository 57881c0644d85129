#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "roadbed/geometry/polygons/ring.h"
#include "roadbed/map/lanelet2/autoware/vector_map.h"

// How lanelets, areas and lines lie on each other, in plan. What the map's budget does not allow
// counts as apart.

namespace roadbed::map::lanelet2::autoware {

using Line2 = std::vector<Eigen::Vector2d>;

/// The points of a way in plan, in map [m]; an area's last point is not repeated.
Line2 plan_of(const VectorMap& map, const Way& way);

/// Area that two rings cover both [m²]; each covers where it winds an odd number of times.
double overlap_m2(const VectorMap& map, const geometry::Ring& a, const geometry::Ring& b);

/// Share of the lanelet's surface that the ring covers, 0 … 1.
double covered_share(const VectorMap& map, const Surface& lanelet, const geometry::Ring& ring);

/// The parts of a line that are inside a ring or on it, between its vertices and crossings.
std::vector<std::pair<Eigen::Vector2d, Eigen::Vector2d>> parts_inside(const VectorMap& map,
                                                                      const Line2& line,
                                                                      const geometry::Ring& ring);

/// Length of the part of a line that is inside a ring or on it, by the line's length, 0 … 1.
double share_inside(const VectorMap& map, const Line2& line, const geometry::Ring& ring);

/// Whether a line and a region have a point in common.
bool touch(const VectorMap& map, const Line2& line, const geometry::Ring& ring);

/// A ring as a line that ends where it begins.
Line2 closed(geometry::Ring ring);

/// Distance from a point to a line [m].
double distance_m(const Eigen::Vector2d& point, const Line2& line);

/// Length of the way through a lanelet: the mean of those of its borders [m].
double way_length_m(const Surface& lanelet);

/// Whether one passes over the other: no point of theirs is within 2.5 m of the same height.
bool on_other_level(const Surface& a, const Surface& b);

/// Lanelets for vehicles that a vehicle on this one can meet, as Lanelet2's routing knows them:
/// their surfaces overlap on one level, and neither follows the other or lies beside it. With the
/// share of this one that each covers; in order of the file.
std::vector<std::pair<const Lanelet*, double>> conflicts(const VectorMap& map,
                                                         const Lanelet& lanelet);

/// Why a way encloses no valid region: "its edges cross"; none if it does, or has no place.
std::optional<std::string> region_fault(const VectorMap& map, const Way& way);

}  // namespace roadbed::map::lanelet2::autoware
