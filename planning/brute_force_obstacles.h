#pragma once

// Private to planning: distances for the check of certificates. It shares nothing with the
// clearance field, so that a fault there is not a fault here.

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <unordered_map>
#include <utility>
#include <vector>

#include "roadbed/geometry/body_part.h"
#include "roadbed/map/occupancy/clearance_field.h"
#include "roadbed/map/occupancy/occupancy_map.h"

namespace roadbed::planning {

/// A part of a vehicle, rectangle or circle, with a margin all around; poses are those of the rear
/// axle's centre.
class BodyOutline {
 public:
  BodyOutline(const geometry::BodyPart& part, double margin_m);

  using Corners = std::array<Eigen::Vector2d, 4>;  ///< counter-clockwise

  /// Where it is: a circle's four corners are its middle.
  struct Place {
    Corners corners;
    double radius_m;

    /// Distance from a rectangle, given by its corners; 0 where they meet.
    double distance_m(const Corners& from) const;
  };
  Place at(double x_m, double y_m, double heading_rad) const;
  double reach_m() const;  ///< from the rear axle's centre to the farthest point

 private:
  double rear_m_, front_m_, right_m_, left_m_, radius_m_;
};

/// Occupied boxes of a height band, and columns of it that were not measured over all its height.
/// Poses are those of the rear axle's centre.
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

  /// Whether it lies in a column that was not measured; of a place that was marked.
  bool is_unknown(const map::Box2& box) const;

  /// Columns within `limit_m` of the body at a place will be asked for; `measure` then looks at
  /// them all at once.
  /// @throws std::length_error if that is too much: over 10⁹ columns in all, or 2·10⁸ different
  ///         ones, or one more than 10⁹ m away.
  void mark(double x_m, double y_m, double limit_m);
  void measure();

  /// As `occupied_m`, for columns that were not measured; around a place that was marked.
  double unknown_m(double x_m, double y_m, double heading_rad, double limit_m) const;

 private:
  using Column = std::int64_t;
  struct Window {
    Column from_x, from_y, to_x, to_y;  // without the last
  };

  void add_occupied(const map::OccupancyCell& cell);
  double ground_m(double x_m, double y_m);
  Window window(const Eigen::Array2d& least, const Eigen::Array2d& most) const;
  Window window_around(const BodyOutline::Place& body, double limit_m) const;
  void measure(const map::OccupancyCell& cell);
  void add(std::vector<float>& tile, const std::pair<Column, Column>& at, const Window& columns,
           const map::OccupancyCell& cell);
  float measured_height_m(const map::OccupancyCell& cell, Column x, Column y);
  bool is_unknown_column(Column x, Column y) const;
  BodyOutline::Corners column_square(Column x, Column y) const;

  const std::vector<map::OccupancyCell>& cells_;
  double resolution_m_;
  map::HeightBand band_;
  BodyOutline body_;
  Eigen::Vector2d corner_ = Eigen::Vector2d::Zero();  // of some cell
  std::vector<double> x_m_, y_m_, half_m_;            // of occupied boxes
  /// Of the ground's places: those that may be the nearest of a point in a tile.
  std::unordered_map<std::int64_t, std::vector<std::size_t>> places_near_;
  double marked_columns_ = 0.0;
  /// Heights, by marked tile; empty where nothing of it was measured.
  std::unordered_map<std::int64_t, std::vector<float>> measured_m_;
};

}  // namespace roadbed::planning
