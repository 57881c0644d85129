#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <span>
#include <vector>

#include "roadbed/geometry/index/box_tree.h"
#include "roadbed/map/edit/clipping/region.h"

namespace roadbed::map::inline edit::inline clipping {

/// What of a region is in a box: the same answers for places there, from the edges near it alone.
/// Who looks closer and closer at a place takes a part of the part, so that long edges that pass
/// elsewhere are not looked at again.
class RegionPart {
 public:
  /// All of it.
  /// @param region  outlives it.
  explicit RegionPart(const Region& region) : region_(&region) {}

  /// @param box  inside that of this part.
  RegionPart within(const geometry::Box& box) const;

  bool contains(const Eigen::Vector2d& point) const;
  bool touches(const Eigen::Vector2d& from, const Eigen::Vector2d& to) const;

  /// What of the disc is in the box counts.
  Region::Side side_of_disc(const Eigen::Vector2d& centre, double radius_m) const;

  /// Whether so few edges are near that a smaller part is not worth it.
  bool is_simple() const;

 private:
  bool is_on_edge(const Eigen::Vector2d& point) const;

  const Region* region_;
  bool is_whole_ = true;              // then the region itself knows
  std::vector<std::uint32_t> edges_;  // near the box
  Eigen::Vector2d known_{0, 0};       // a place in the box, on no edge
  bool is_inside_ = false;            // whether it is inside the region
};

/// Asks a region about discs most of which lie in the box of one that was asked about before, as
/// those of a tree's cubes do from the root to the leaves: each from the edges near it alone.
class RegionDescent {
 public:
  /// @param region  outlives it.
  explicit RegionDescent(const Region& region) : whole_(region) {}

  /// As Region::side_of_disc.
  Region::Side side_of_disc(const Eigen::Vector2d& centre, double radius_m);

 private:
  struct Level {
    geometry::Box box;
    RegionPart part;
  };

  RegionPart whole_;
  std::vector<Level> levels_;  // each in the one before
};

/// Of each of many points, from one to the next, whether the region contains it. O((N + points)
/// log points) for points along a line, however long the edges are that it crosses.
std::vector<bool> contains_each(const Region& region, std::span<const Eigen::Vector2d> points);

}  // namespace roadbed::map::edit::clipping
