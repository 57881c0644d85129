#pragma once

// Private to map/occupancy.

#include <Eigen/Core>
#include <cstdint>
#include <functional>
#include <mutex>
#include <optional>
#include <vector>

#include "roadbed/map/occupancy/clearance/cell_bits.h"
#include "roadbed/map/occupancy/clearance/field_region.h"
#include "roadbed/map/occupancy/clearance/rectangle_search.h"
#include "roadbed/map/occupancy/octree/cell_range.h"

namespace roadbed::map::inline occupancy::inline clearance {

class RectangleCover;

/// A leaf of the octree within a height band: its cells, and how many layers of the band it fills.
struct Slab {
  CellRange cells;
  std::int64_t layers;
  bool occupied;
};

/// Goes through the slabs that meet a range, and others perhaps.
using UseSlab = std::function<void(const Slab& slab)>;
using SlabsIn = std::function<void(const CellRange& range, const UseSlab& use)>;

/// Which cells a grid knows of.
struct GridExtent {
  CellRange held;  ///< distances are kept for these
  CellRange seen;  ///< what they are measured to; holds all of `held`
  bool is_all;     ///< nothing was measured outside `seen`; else what lies there does not matter
};

/// A grid in plan view: which cells are occupied, how much of each was measured, and how far away
/// the next occupied or unknown one is. Coordinates are metres from the corner of cell (0, 0), so
/// that a cell has the same numbers in every grid that knows of it.
class PlanGrid {
 public:
  /// Asks for slabs a million cells at a time, so that they take little memory beside the grid.
  PlanGrid(const SlabsIn& slabs_in, const GridExtent& extent, std::int64_t layers, double cell_m);

  double cell_m() const { return cell_m_; }
  Eigen::Vector2d centre(std::int64_t x, std::int64_t y) const {
    return {(static_cast<double>(x) + 0.5) * cell_m_, (static_cast<double>(y) + 0.5) * cell_m_};
  }

  /// Lower bound of the distance from a point to the nearest cell of the kind.
  double lower_bound_m(const Eigen::Vector2d& point, ObstacleKind kind) const;

  /// Exact distance from a rectangle; none if it is over `within_m`. The cell may lie just outside
  /// what is seen, where all is unknown.
  std::optional<NearCell> nearest(const geometry::Rectangle& rectangle, double within_m,
                                  ObstacleKind kind) const;

  /// The cell nearest to a rectangle of which a layer was measured; none if it is over `within_m`.
  std::optional<NearCell> nearest_measured(const geometry::Rectangle& rectangle,
                                           double within_m) const;

  /// All cells of the kind among those that a rectangle may touch; their distances are not told.
  std::vector<NearCell> cells_at(const geometry::Rectangle& rectangle, ObstacleKind kind) const;

  /// Fraction of a rectangle's part of the band that was never measured.
  double unknown_fraction(const geometry::Rectangle& rectangle) const;

 private:
  struct Layer {
    CellBits bits;                 // of cells seen
    std::vector<float> distances;  // of cells held: in cells, from centre to centre
  };
  struct Measured {
    CellBits in_part, not_in_all;  // of its layers
  };
  struct Cell {
    std::int64_t x, y;
  };

  Cell cell_at(const Eigen::Vector2d& point) const;
  /// Whether nothing was measured: then no cell is kept, as a drive may go far through such space.
  bool is_blank() const { return known_layers_.empty(); }
  void paint(const Slab& slab, const CellRange& range, std::vector<std::uint8_t>& occupied);
  Layer layer_of(const std::vector<std::uint8_t>& set) const;
  const Layer& layer(ObstacleKind kind) const;
  const Measured& measured() const;
  bool is_any_unknown(const CellRange& cells) const;
  bool is_any_measured(const CellRange& cells) const;
  double unknown_cells(const RectangleCover& cover) const;
  double bound_m(const Cell& cell, const Eigen::Vector2d& point, const Layer& layer) const;
  double bound_from_outside_m(const Eigen::Vector2d& point, ObstacleKind kind) const;
  double upper_bound_m(const Eigen::Vector2d& point, const Layer& layer) const;
  double reach_m(const geometry::Rectangle& rectangle, double within_m, const Layer& layer) const;
  NearCell nearest_outside(const geometry::Rectangle& rectangle) const;
  NearCell nearest_in_blank(const geometry::Rectangle& rectangle) const;
  std::optional<NearCell> nearest_inside(const geometry::Rectangle& rectangle, double within_m,
                                         ObstacleKind kind) const;

  double cell_m_, per_cell_;
  GridExtent extent_;
  std::uint16_t layers_;
  std::vector<std::uint16_t> known_layers_;  // all of them where one is occupied
  Layer occupied_;
  mutable std::once_flag unknown_once_;
  mutable Layer unknown_;
  mutable std::once_flag measured_once_;
  mutable Measured measured_;
};

}  // namespace roadbed::map::occupancy::clearance
