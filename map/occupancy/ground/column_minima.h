#pragma once

// Private to map/occupancy/ground.

#include <Eigen/Core>
#include <cstdint>
#include <unordered_map>
#include <utility>
#include <vector>

#include "roadbed/map/occupancy/octree/occupancy_source.h"

namespace roadbed::map::inline occupancy::inline ground {

/// The lowest occupied cell of each column around some points. Columns elsewhere are not kept:
/// what is kept follows the points, not the size of a cell or of the space between the points.
class ColumnMinima {
 public:
  /// @pre there is a point.
  /// @throws InputError if the points have over 5·10⁷ columns around.
  ColumnMinima(const map::OccupancySource& occupancy, const std::vector<Eigen::Vector2d>& points,
               double radius_m);

  double cell_m() const { return cell_m_; }

  /// Middles of the cells of columns within the radius of one of the points.
  std::vector<Eigen::Vector3d> around(const Eigen::Vector2d& point) const;

 private:
  using Column = std::int64_t;
  struct Columns {
    Column from_x, from_y, to_x, to_y;  // without the last
  };

  Columns columns_around(const Eigen::Vector2d& point) const;
  void want(const Columns& columns);
  void add(const map::OccupancyCell& leaf);
  void add(std::vector<float>& tile, const std::pair<Column, Column>& at, const Columns& columns,
           double z_m) const;

  double cell_m_, radius_m_;
  Eigen::Vector3d origin_;
  std::unordered_map<Column, std::vector<float>> tiles_;  // heights above the origin
};

}  // namespace roadbed::map::occupancy::ground
