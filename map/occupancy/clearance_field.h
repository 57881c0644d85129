#pragma once

#include <Eigen/Core>
#include <memory>
#include <optional>

#include "roadbed/geometry/pose2.h"
#include "roadbed/geometry/vehicle_shape.h"
#include "roadbed/map/occupancy/occupancy_map.h"

namespace roadbed::map {

/// The heights that a vehicle's body takes; what is above or below does not touch it.
struct HeightBand {
  double from_m = 0.2;
  double to_m = 1.5;
};

/// An axis-aligned box in plan view, in source coordinates.
struct Box2 {
  Eigen::Vector2d min_in_source, max_in_source;
};

/// Occupied and unknown space of one height band in plan view, with distances to it.
///
/// Plan coordinates are source coordinates. Distances are between exact shapes: the vehicle's
/// rectangle and the boxes of occupied cells.
class ClearanceField {
 public:
  ClearanceField(const OccupancyMap& occupancy, const HeightBand& band);
  ~ClearanceField();
  ClearanceField(ClearanceField&&) noexcept;
  ClearanceField& operator=(ClearanceField&&) noexcept;

  /// A lower bound of the distance from a point to the nearest occupied box [m]; never above the
  /// true one. O(1) inside the field; beyond `horizon_m` the horizon is returned.
  double distance_bound_m(const Eigen::Vector2d& point_in_source) const;

  /// Distance beyond which the bound is not told apart.
  double horizon_m() const;

  struct Nearest {
    double distance_m;  ///< 0 on overlap
    Box2 witness;       ///< the nearest occupied box
  };

  /// Exact distance between the vehicle's rectangle at a pose and the nearest occupied box; none
  /// where no box is within `within_m`.
  std::optional<Nearest> nearest(const geometry::Pose2& source_from_vehicle,
                                 const geometry::VehicleShape& shape, double within_m) const;

  /// Share of the vehicle's rectangle at a pose that lies on cells never measured, 0 … 1.
  double unknown_share(const geometry::Pose2& source_from_vehicle,
                       const geometry::VehicleShape& shape) const;

 private:
  struct Grid;
  std::unique_ptr<const Grid> grid_;
};

}  // namespace roadbed::map
