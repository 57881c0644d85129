#pragma once

// Private to planning/audit: distances for the check of certificates. It shares nothing with the
// clearance field, so that a fault there is not a fault here.

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <unordered_map>
#include <utility>
#include <vector>

#include "roadbed/map/occupancy/clearance/clearance_field.h"
#include "roadbed/map/occupancy/octree/occupancy_map.h"
#include "roadbed/planning/audit/check/body_outline.h"
#include "roadbed/planning/audit/check/box_grid.h"

namespace roadbed::planning::inline audit {

/// Occupied boxes of a height band, and what of its columns was measured. Poses are those of the
/// rear axle's centre.
class BruteForceObstacles {
 public:
  /// @throws std::length_error if over a ground they have over 2·10⁷ columns.
  BruteForceObstacles(const std::vector<map::OccupancyCell>& cells, double resolution_m,
                      const map::HeightBand& band, const BodyOutline& body);

  /// Exact distance from the body to the nearest occupied box, or `limit_m` if that is less.
  double occupied_m(double x_m, double y_m, double heading_rad, double limit_m) const;

  /// Exact distance from the body to one box.
  double to_box_m(double x_m, double y_m, double heading_rad, const map::Box2& box) const;

  /// Whether a box's middle lies in an occupied one.
  bool is_occupied(const map::Box2& box) const;

  /// Columns within `limit_m` of the body at a place will be asked for; `measure` then looks at
  /// them all at once.
  /// @throws std::length_error if that is too much: 64 by 64 columns over 50,000 times, or one more
  ///         than 10⁹ m away.
  void mark(double x_m, double y_m, double limit_m);
  void measure();

  /// Whether a box's middle lies in a column that was not measured all over; of a marked place, and
  /// so below.
  bool is_unknown(const map::Box2& box) const;

  /// As `occupied_m`, for columns that were not measured all over.
  double unknown_m(double x_m, double y_m, double heading_rad, double limit_m) const;

  /// The box of the column of a point, if anything of it was measured.
  std::optional<map::Box2> measured_column(const Eigen::Vector2d& point) const;

  /// Fraction of the space over the box around the body that was measured, 0 … 1.
  double measured_fraction(double x_m, double y_m, double heading_rad) const;

 private:
  using Column = std::int64_t;
  struct Window {
    Column from_x, from_y, to_x, to_y;  // without the last
  };

  void add_occupied(const map::OccupancyCell& cell);
  double ground_m(double x_m, double y_m);
  Window window(const Eigen::Array2d& least, const Eigen::Array2d& most) const;
  void measure(const map::OccupancyCell& cell);
  void add(std::vector<float>& tile, const std::pair<Column, Column>& at, const Window& columns,
           const map::OccupancyCell& cell);
  float measured_height(const map::OccupancyCell& cell, Column x, Column y);
  void add_unknown(const std::pair<Column, Column>& at, const std::vector<float>& tile);
  bool is_unknown_height(float measured) const;
  double measured_fraction(Column x, Column y) const;
  map::Box2 columns_box(const Window& columns) const;

  const std::vector<map::OccupancyCell>& cells_;
  double resolution_m_;
  map::HeightBand band_;
  BodyOutline body_;
  Eigen::Vector3d corner_ = Eigen::Vector3d::Zero();  // of some cell
  double whole_ = 0.0;  // height of the band: in layers over level ground, else in metres
  BoxGrid occupied_, unknown_;
  /// Of the ground's places: those that may be the nearest of a point in a tile.
  std::unordered_map<std::int64_t, std::vector<std::size_t>> places_near_;
  std::size_t marked_tiles_ = 0;
  /// Heights, by marked tile; empty where nothing of it was measured.
  std::unordered_map<std::int64_t, std::vector<float>> measured_;
};

}  // namespace roadbed::planning::audit
