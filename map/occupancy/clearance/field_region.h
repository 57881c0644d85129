#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cstddef>

#include "roadbed/map/occupancy/ground/ground.h"

namespace roadbed::map::inline occupancy::inline clearance {

/// The heights that a vehicle's body takes; what is above or below, or only touches the band's end,
/// does not count. With a ground they are above that, column by column, else in source coordinates:
/// over level ground at height g they are g + 0.2 … g + height.
struct HeightBand {
  double from_m = 0.2;
  double to_m = 1.5;
  const Ground* ground = nullptr;  ///< not owned

  /// Whether a box that begins at a height and is so high reaches into the band, by more than a
  /// touch, in the column of a point.
  bool holds(const Eigen::Vector2d& in_source, double low_m, double height_m) const {
    constexpr double touch_m = 1e-6;  // what overlaps the band by less only touches it
    const double above_m = ground ? low_m - ground->height_m(in_source) : low_m;
    return std::min(above_m + height_m, to_m) - std::max(above_m, from_m) > touch_m;
  }
};

/// An axis-aligned box in plan view, in source coordinates.
struct Box2 {
  Eigen::Vector2d min_in_source, max_in_source;
};

/// The part of an occupancy that a field is made for: queries stay in `around`, and what is more
/// than `horizon_m` away does not matter.
struct FieldRegion {
  Box2 around;
  double horizon_m = 50.0;

  /// Where a grid of all that would have over `kMostCells` cells it is made in square tiles of this
  /// side, only where queries come; 0: of a fitting side. Given, it is made in tiles in any case.
  double tile_m = 0.0;
  double body_radius_m = 10.0;  ///< tiles are made for rectangles within such a circle

  /// Cells that may be alive at a time, over which a tile by itself may be; less than
  /// `ClearanceField::kMostCells` where several fields are in use at the same time.
  std::size_t most_cells = 100'000'000;
};

/// What a distance is measured to.
enum class ObstacleKind {
  occupied,  ///< cells with a measured hit
  unknown,   ///< columns of the band that were not measured over their whole height, and all
             ///< space outside the measured bounds
};

}  // namespace roadbed::map::occupancy::clearance
