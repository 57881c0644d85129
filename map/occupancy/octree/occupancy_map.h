#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "roadbed/map/occupancy/clouds/cloud_filter.h"
#include "roadbed/map/occupancy/octree/occupancy_options.h"
#include "roadbed/map/occupancy/octree/occupancy_source.h"

namespace roadbed::map::inline occupancy::inline octree {

/// Obstacle occupancy, an octree like OctoMap's. A measured hit is sticky: rays never carve it
/// away, unless the options say otherwise.
class OccupancyMap final : public OccupancySource {
 public:
  /// Clouds with a sensor position carve free space along their rays; others only mark hits.
  /// Cost: a step per cell that a ray crosses; of points in the same cell one ray is drawn.
  /// @throws InputError if a point or sensor lies beyond OctoMap's ±32768 cells of the origin, or
  ///         the rays cross too many cells to be kept.
  /// @throws std::invalid_argument if there is no point, an option is not positive, or
  ///         `remove_seen_through` is not 0 to 255 or comes with hits that are not sticky.
  static OccupancyMap build(std::span<const PointCloud> clouds, const OccupancyOptions& options);

  /// The same of clouds that are gone through twice, for bounds and for cells.
  static OccupancyMap build(const CloudsInTurn& clouds, const OccupancyOptions& options);

  struct File {
    std::string bytes;
    std::size_t nodes;
    std::optional<SeeThroughRemoval> seen_through = {};
  };

  /// The bytes of `build(…).to_bt()`, without making the tree: half the time and a quarter of the
  /// memory.
  /// @throws as `build`.
  static File build_bt(std::span<const PointCloud> clouds, const OccupancyOptions& options);
  /// The same of clouds that are gone through twice.
  static File build_bt(const CloudsInTurn& clouds, const OccupancyOptions& options);

  /// Reads `.bt` or `.ot`; the header, depth and node count are checked before a node is made.
  /// @throws InputError if the file is unusable.
  static OccupancyMap load(const std::filesystem::path& file);

  /// The same from bytes; `name` stands for the file in messages.
  static OccupancyMap parse(std::string_view bytes, const std::string& name);

  ~OccupancyMap() override;
  OccupancyMap(OccupancyMap&&) noexcept;
  OccupancyMap& operator=(OccupancyMap&&) noexcept;

  double resolution_m() const override;
  const Eigen::Vector3d& origin_in_source() const override;
  const std::string& crs() const override;
  std::optional<SeeThroughRemoval> seen_through() const override;
  std::size_t node_count() const;

  std::optional<Box3> bounds() const override;

  /// State at a point; beyond the octree's range it is unknown. O(16).
  CellState at(const Eigen::Vector3d& in_source) const;

  void for_each_cell(const UseCell& use) const override;

  /// In the same order. O(leaves in the box).
  void for_each_in(const Box3& box, const UseCell& use) const override;

  /// The bytes of a standard `.bt` with a line `# roadbed origin X Y Z CRS`, and one
  /// `# roadbed seen-through CLOUDS removed CELLS` where hits were taken away. Log-odds of an `.ot`
  /// become free and occupied at OctoMap's threshold, 0.
  std::string to_bt() const;

  /// The bytes of a standard `.ot`, with the log-odds, and the same lines.
  std::string to_ot() const;

 private:
  struct Tree;
  explicit OccupancyMap(std::unique_ptr<Tree> tree);
  std::unique_ptr<Tree> tree_;
};

/// Whether the bytes begin as a `.bt` or `.ot` does.
bool is_occupancy_file(std::string_view bytes);

/// Occupancy from one `.bt` or `.ot` file, which keeps its own resolution, or from any number of
/// point clouds, which carve from their files' viewpoints.
/// @param filter  of the clouds; neighbours are not looked at.
/// @throws InputError if a file is unusable, an octree is not the only file or to be filtered, or
/// no
///         point is left.
OccupancyMap load_occupancy(std::span<const std::filesystem::path> files,
                            const OccupancyOptions& options = {}, const CloudFilter& filter = {});

/// The same from the clouds of a log.
OccupancyMap load_occupancy_of_log(const std::filesystem::path& log,
                                   const CloudFilter& filter = {});

/// @throws InputError that an octree or tiles cannot be filtered any more.
[[noreturn]] void refuse_to_filter(const std::string& name);

}  // namespace roadbed::map::occupancy::octree
