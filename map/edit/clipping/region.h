#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "roadbed/geometry/index/box_tree.h"
#include "roadbed/geometry/polygons/ring.h"

namespace roadbed::map::inline edit::inline clipping {

/// Of a ring, from one corner to the next.
struct RegionEdge {
  Eigen::Vector2d from, to;

  double distance_m(const Eigen::Vector2d& point) const;

  /// Where a segment meets it, as a fraction of the segment; none where they are parallel or apart.
  std::optional<double> meeting(const Eigen::Vector2d& segment_from,
                                const Eigen::Vector2d& segment_to) const;
};

/// A part of the plane that a map is cut to: what an odd number of rings encloses, their edges
/// included. Coordinates are the source's. Immutable.
class Region {
 public:
  /// @param rings  each of three points or more, finite, in either sense.
  /// @throws std::invalid_argument if there is no ring, or one is shorter.
  explicit Region(std::vector<geometry::Ring> rings);

  /// The same for polygons: their holes are outside.
  explicit Region(const std::vector<geometry::Polygon>& polygons);

  /// Whether a point is inside or on an edge. Exact. O(log N + edges to its right).
  bool contains(const Eigen::Vector2d& point) const;

  /// Whether any point of the segment is inside.
  bool touches(const Eigen::Vector2d& from, const Eigen::Vector2d& to) const;

  /// Where the segment crosses edges, as fractions of its length, in order, within [0, 1].
  std::vector<double> crossings(const Eigen::Vector2d& from, const Eigen::Vector2d& to) const;

  /// Where the disc lies; `border` where an edge may meet it.
  enum class Side { inside, outside, border };
  Side side_of_disc(const Eigen::Vector2d& centre, double radius_m) const;

  /// A box around all rings.
  const geometry::Box& bounds() const { return bounds_; }

  /// A corner of each ring.
  const std::vector<Eigen::Vector2d>& corners() const { return corners_; }

 private:
  friend class RegionPart;

  std::vector<RegionEdge> edges_;
  geometry::BoxTree tree_;
  geometry::Box bounds_;
  std::vector<Eigen::Vector2d> corners_;
};

/// All points within a distance of a line: a chain of segments with round ends and corners, whose
/// arcs are replaced by chords outside of them, at most 0.1 % of the distance away.
/// @throws std::invalid_argument if the distance is not positive or the line has no point.
Region region_around(const std::vector<Eigen::Vector2d>& line, double distance_m);

}  // namespace roadbed::map::edit::clipping
