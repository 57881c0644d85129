#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <string>

#include "roadbed/map/occupancy/octree/occupancy_source.h"

namespace roadbed::map::inline occupancy::inline octree {

/// A place in cells of the finest size, along x, y and z.
using CellPlace = std::array<std::int64_t, 3>;

/// Cells of the finest size, half open.
struct CellBox {
  CellPlace from{}, to{};

  bool empty() const { return from[0] >= to[0] || from[1] >= to[1] || from[2] >= to[2]; }
  CellBox cut(const CellBox& other) const;
  CellBox joined(const CellBox& other) const;
  bool operator==(const CellBox&) const = default;
};

/// The cells of an occupancy, counted from its origin.
class CellGrid {
 public:
  explicit CellGrid(const OccupancySource& occupancy)
      : origin_in_source_(occupancy.origin_in_source()), resolution_m_(occupancy.resolution_m()) {}

  /// The cells that a leaf is.
  CellBox cells_of(const OccupancyCell& leaf) const;

  /// The cells that overlap a box by more than a millionth of a cell; its sides may be infinitely
  /// far away.
  CellBox cells_of(const Box3& box) const;

  /// The cells whose middle lies in a box or less than a millionth of a cell outside; its sides may
  /// be infinitely far away.
  CellBox cells_with_middle_in(const Box3& box) const;

  Eigen::Vector3d corner_in_source(const CellPlace& cell) const;
  Box3 box_in_source(const CellBox& cells) const;

 private:
  Eigen::Vector3d origin_in_source_;
  double resolution_m_;
};

/// Whether cells of two occupancies are the same cells: of one size, in one coordinate system, and
/// of origins that are whole cells apart.
/// @param name, other_name  of their files, for messages.
/// @throws InputError if they are not.
void check_one_grid(const OccupancySource& occupancy, const std::string& name,
                    const OccupancySource& other, const std::string& other_name);

}  // namespace roadbed::map::occupancy::octree
