#pragma once

// Private to map/occupancy.

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <vector>

#include "roadbed/map/occupancy/clearance/field_region.h"
#include "roadbed/map/occupancy/clearance/plan_grid.h"
#include "roadbed/map/occupancy/octree/occupancy_source.h"

namespace roadbed::map::inline occupancy::inline clearance {

/// Turns leaves of an octree into slabs of a height band, level or over a ground.
class HeightBandSlicer {
 public:
  /// @param source  kept by reference.
  HeightBandSlicer(const OccupancySource& source, const HeightBand& band);

  /// Of a column that was measured over its whole height.
  std::int64_t layers() const;
  double cell_m() const { return cell_m_; }
  Eigen::Vector2d origin_in_source() const { return origin_.head<2>(); }

  /// The cells that a box touches, and those up to `margin_m` around it.
  CellRange range(const Box2& box, double margin_m) const;

  /// Goes through the slabs that meet a range, uncut.
  void for_each_slab_in(const CellRange& range, const UseSlab& use) const;

  /// All slabs. @pre the band is level.
  std::vector<Slab> slabs() const;

 private:
  std::int64_t to_cells(double metres) const;
  std::optional<Slab> slab_of(const OccupancyCell& leaf) const;

  const OccupancySource& source_;
  HeightBand band_;
  Eigen::Vector3d origin_;
  double cell_m_, per_cell_;
  std::int64_t from_layer_, to_layer_;
};

}  // namespace roadbed::map::occupancy::clearance
