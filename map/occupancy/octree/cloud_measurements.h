#pragma once

// Private to map/occupancy.

#include <Eigen/Core>
#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "roadbed/map/occupancy/clouds/point_cloud.h"
#include "roadbed/map/occupancy/octree/cell_blocks.h"
#include "roadbed/map/occupancy/octree/free_space_rays.h"
#include "roadbed/map/occupancy/octree/occupancy_options.h"
#include "roadbed/map/occupancy/octree/octree_bytes.h"
#include "roadbed/map/occupancy/octree/scan_accumulator.h"

namespace roadbed::map::inline occupancy::inline octree {

/// The key of the cell that a point lies in; none beyond OctoMap's ±32768 cells.
std::optional<CellKey> key_at(const Eigen::Vector3d& in_tree, double resolution_m);

/// Collects what clouds measured, cell by cell. Points with one sensor position are one scan: each
/// cell counts once, as hit where a point lies in it, else as free where a ray crosses it.
class CloudMeasurements {
 public:
  /// @param sum     of the same options; or of none, to keep what was measured as it is.
  /// @param points  of all clouds that will come: what they may take of memory depends on it.
  CloudMeasurements(const Eigen::Vector3d& origin_in_source, const OccupancyOptions& options,
                    ScanAccumulator sum, std::size_t points);

  /// @throws InputError if a point or the sensor lies out of range, or what was measured lies in
  ///         too many places to be kept.
  void add(const PointCloud& cloud);

  const CellBlocks& blocks() const { return blocks_; }

  /// Of a `.bt`; to be called once, when all clouds are there.
  OctreeBytes bt();

  /// Cells whose hits went since clouds saw through them; known after `bt`.
  std::size_t removed() const { return sum_.removed(); }

  /// Of an `.ot`. @pre hits are not sticky.
  OctreeBytes ot() const;

 private:
  CellKey checked_key(const PointCloud& cloud, const char* what,
                      const Eigen::Vector3d& in_source) const;
  // Points of a cloud, from one on up to another, without that one.
  struct Span {
    std::size_t first, last;
  };
  std::span<const CellKey> keys_of(const PointCloud& cloud, Span points);
  void add(const PointCloud& cloud, Span points, const std::optional<Eigen::Vector3d>& sensor);
  void add_hits(const PointCloud& cloud, Span points);
  void add_scan(const PointCloud& cloud, Span points, const Eigen::Vector3d& sensor_in_source);
  void add_ray(const Eigen::Vector3f& sensor, const CellKey& from, const CellKey& key,
               const CellBlocks::End& end);
  void add_carved(const PointCloud& cloud);
  void check_room(const PointCloud& cloud) const;
  void take_touched();

  Eigen::Vector3d origin_in_source_;
  OccupancyOptions options_;
  std::size_t most_bytes_;
  CellBlocks blocks_;
  ScanAccumulator sum_;
  FreeSpaceRays carved_;  // by the scan that is being added
  std::vector<CellKey> keys_;
};

/// What clouds measured, and where.
struct MeasuredClouds {
  Eigen::Vector3d origin_in_source;
  std::string crs;
  CloudMeasurements cells;
};

/// @throws as `OccupancyMap::build`, and if the clouds have more than one CRS.
MeasuredClouds measure_clouds(const CloudsInTurn& clouds, const OccupancyOptions& options);

}  // namespace roadbed::map::occupancy::octree
