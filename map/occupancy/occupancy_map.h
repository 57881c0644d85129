#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "roadbed/map/occupancy/point_cloud.h"

namespace roadbed::map {

struct OccupancyOptions {
  double resolution_m = 0.1;
};

/// Measured at a cell: nothing, a way through, or a thing.
enum class CellState { unknown, free, occupied };

/// An axis-aligned box of occupied or free space, a leaf of the octree.
struct OccupancyCell {
  Eigen::Vector3d centre_in_source;
  double size_m;
  CellState state;
};

/// Obstacle occupancy, kept as an OctoMap. A measured hit is sticky: rays never carve it away.
class OccupancyMap {
 public:
  /// Clouds with a sensor position carve free space along their rays; others only mark hits.
  static OccupancyMap build(std::span<const PointCloud> clouds, const OccupancyOptions& options);

  /// Reads `.bt` or `.ot`; the header, depth and node count are checked before OctoMap sees a byte.
  /// @throws InputError if the file is unusable.
  static OccupancyMap load(const std::filesystem::path& file);

  ~OccupancyMap();
  OccupancyMap(OccupancyMap&&) noexcept;
  OccupancyMap& operator=(OccupancyMap&&) noexcept;

  double resolution_m() const;
  const Eigen::Vector3d& origin_in_source() const;
  const std::string& crs() const;
  std::size_t node_count() const;

  CellState at(const Eigen::Vector3d& in_source) const;

  /// All leaves with a state, in the octree's own order.
  std::vector<OccupancyCell> cells() const;

  /// The bytes of a standard `.bt` with a line `# roadbed origin X Y Z CRS`.
  std::string to_bt() const;

 private:
  struct Tree;
  explicit OccupancyMap(std::unique_ptr<Tree> tree);
  std::unique_ptr<Tree> tree_;
};

}  // namespace roadbed::map
