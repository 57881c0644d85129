#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <memory>
#include <optional>
#include <vector>

#include "roadbed/geometry/motion/rectangle.h"
#include "roadbed/geometry/motion/vehicle_shape.h"
#include "roadbed/geometry/primitives/pose2.h"
#include "roadbed/map/occupancy/clearance/field_region.h"
#include "roadbed/map/occupancy/octree/occupancy_source.h"

namespace roadbed::map::inline occupancy::inline clearance {

/// Occupied and unknown space of one height band in plan view, with distances to it.
///
/// Plan coordinates are source coordinates. The grid has the octree's resolution; larger leaves are
/// squares of several cells, so distances are between exact shapes: the vehicle's rectangle and the
/// boxes of occupied cells.
class ClearanceField {
 public:
  /// Cells within a horizon of the region take 2 bytes and a bit of memory, those of the region
  /// itself 4 more, twice that once unknown space is asked for. O(leaves + cells). In tiles no more
  /// than `kMostCells` cells are alive at a time, and the answers are the same, bit for bit.
  ///
  /// Without a region questions may be asked anywhere. The horizon is 1 km then; where all that was
  /// measured has over `kMostCells` cells it is made in tiles, with a horizon of 50 m, for bodies
  /// within a circle of 20 m.
  /// @param occupancy  kept by reference, as tiles are made later.
  /// @throws InputError if a tile by itself has over `kMostCells` cells.
  /// @throws std::invalid_argument if the band is empty or not finite.
  ClearanceField(const OccupancySource& occupancy, const HeightBand& band,
                 const std::optional<FieldRegion>& region = std::nullopt);
  ~ClearanceField();
  ClearanceField(ClearanceField&&) noexcept;
  ClearanceField& operator=(ClearanceField&&) noexcept;

  static constexpr std::size_t kMostCells = 100'000'000;
  static constexpr std::size_t kMostOfOneGrid = 20'000'000;  ///< around a region; else in tiles

  /// A lower bound of the distance from a point to the nearest box [m]; never above the true one,
  /// and among the boxes at most two cell diagonals below it. At most `horizon_m`. O(1).
  double distance_bound_m(const Eigen::Vector2d& point_in_source,
                          ObstacleKind kind = ObstacleKind::occupied) const;

  /// Distance beyond which the bound is not told apart.
  double horizon_m() const;

  /// Whether a rectangle keeps within the field's region and is no larger than the bodies that the
  /// region names: then `nearest` may be asked, and the answer is the same in tiles or without.
  bool is_made_for(const geometry::Rectangle& in_source) const;

  struct Nearest {
    double distance_m;  ///< 0 on overlap or touch
    Box2 witness;       ///< the nearest box, of one cell; of equally near ones always the same
  };

  /// Exact distance between a rectangle, or a point, and the nearest box; none where no box is
  /// within `within_m` (or within the horizon, if that is less).
  /// @throws std::invalid_argument if the rectangle leaves the field's region, or is too large for
  ///         its tiles.
  std::optional<Nearest> nearest(const geometry::Rectangle& in_source, double within_m,
                                 ObstacleKind kind = ObstacleKind::occupied) const;

  /// The same for the vehicle's rectangle at a pose.
  std::optional<Nearest> nearest(const geometry::Pose2& source_from_vehicle,
                                 const geometry::VehicleShape& shape, double within_m,
                                 ObstacleKind kind = ObstacleKind::occupied) const {
    return nearest(geometry::body_at(source_from_vehicle, shape), within_m, kind);
  }

  /// The nearest column of the band of which anything was measured, free or occupied; none where
  /// none is within `within_m` or the horizon.
  /// @throws std::invalid_argument as `nearest`.
  std::optional<Nearest> nearest_measured(const geometry::Rectangle& in_source,
                                          double within_m) const;

  /// The boxes of all cells of a kind that a rectangle's bounding box may touch. O(cells of it).
  std::vector<Box2> boxes_at(const geometry::Rectangle& in_source, ObstacleKind kind) const;

  /// Fraction of the space over a rectangle in the band that was never measured, 0 … 1. Exactly 0
  /// only where nothing of it is unknown.
  double unknown_fraction(const geometry::Rectangle& in_source) const;

  /// The same for the vehicle's rectangle at a pose.
  double unknown_fraction(const geometry::Pose2& source_from_vehicle,
                          const geometry::VehicleShape& shape) const {
    return unknown_fraction(geometry::body_at(source_from_vehicle, shape));
  }

 private:
  struct Grid;
  std::unique_ptr<Grid> grid_;
};

}  // namespace roadbed::map::occupancy::clearance
