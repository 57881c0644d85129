#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "roadbed/map/occupancy/clouds/point_cloud.h"

namespace roadbed::map::inline occupancy::inline octree {

/// Measured at a cell: nothing, a way through, or a thing.
enum class CellState : std::uint8_t { unknown, free, occupied };

/// An axis-aligned box of occupied or free space, a leaf of the octree.
struct OccupancyCell {
  Eigen::Vector3d centre_in_source;
  double size_m;
  CellState state;
  float log_odds = 0.0f;  ///< of being occupied; where only the state is known, OctoMap's limits
};

/// What a removal of dynamic objects took away: hits whose cells later or earlier clouds saw
/// through.
struct SeeThroughRemoval {
  int clouds = 0;         ///< at least so many, and more than hit it
  std::size_t cells = 0;  ///< that count as free though a point lies in them

  bool operator==(const SeeThroughRemoval&) const = default;
};

/// Where cells of occupied and free space come from.
class OccupancySource {
 public:
  virtual ~OccupancySource() = default;

  virtual double resolution_m() const = 0;
  virtual const Eigen::Vector3d& origin_in_source() const = 0;

  virtual const std::string& crs() const = 0;

  /// What was taken away of what was measured; none where every hit was kept.
  virtual std::optional<SeeThroughRemoval> seen_through() const = 0;

  /// Around all leaves; none if there is none.
  virtual std::optional<Box3> bounds() const = 0;

  /// Takes a leaf.
  using UseCell = std::function<void(const OccupancyCell&)>;

  /// Goes through all leaves with a state, one after the other, in the octree's own order.
  virtual void for_each_cell(const UseCell& use) const = 0;

  /// The same as a list, which takes 40 bytes a leaf; they are counted first.
  std::vector<OccupancyCell> cells() const;

  /// Goes through those that overlap a box, and some around it perhaps. Several threads may.
  virtual void for_each_in(const Box3& box, const UseCell& use) const = 0;

  /// Those as a list.
  std::vector<OccupancyCell> cells_in(const Box3& box) const;

 protected:
  OccupancySource() = default;
  OccupancySource(const OccupancySource&) = default;
  OccupancySource(OccupancySource&&) = default;
  OccupancySource& operator=(const OccupancySource&) = default;
  OccupancySource& operator=(OccupancySource&&) = default;
};

inline std::vector<OccupancyCell> OccupancySource::cells() const {
  std::size_t count = 0;
  for_each_cell([&](const OccupancyCell&) { ++count; });
  std::vector<OccupancyCell> cells;
  cells.reserve(count);
  for_each_cell([&](const OccupancyCell& cell) { cells.push_back(cell); });
  return cells;
}

inline std::vector<OccupancyCell> OccupancySource::cells_in(const Box3& box) const {
  std::vector<OccupancyCell> cells;
  for_each_in(box, [&](const OccupancyCell& cell) { cells.push_back(cell); });
  return cells;
}

}  // namespace roadbed::map::occupancy::octree
