#pragma once

#include <cstddef>
#include <filesystem>
#include <list>
#include <memory>
#include <mutex>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "roadbed/map/occupancy/octree/occupancy_map.h"
#include "roadbed/map/occupancy/octree/tiles_index.h"

namespace roadbed::map::inline occupancy::inline octree {

/// An occupancy in a folder of `.bt` files, of which only those are read that are asked for. The
/// last used ones stay in memory; threads may ask at the same time.
class TiledOccupancy final : public OccupancySource {
 public:
  static constexpr std::size_t kMostAlive = 16;  ///< tiles in memory

  /// Reads the index only.
  /// @throws InputError if that is unusable.
  explicit TiledOccupancy(const std::filesystem::path& folder);

  const TilesIndex& index() const { return index_; }
  double resolution_m() const override { return index_.resolution_m; }
  const Eigen::Vector3d& origin_in_source() const override { return index_.origin_in_source; }
  const std::string& crs() const override { return index_.crs; }
  std::optional<SeeThroughRemoval> seen_through() const override { return index_.seen_through; }
  std::optional<Box3> bounds() const override;

  /// Of all tiles, one after the other: as much memory as all leaves take.
  /// @throws InputError if a tile is missing, unusable, or not the one that the index names.
  void for_each_cell(const UseCell& use) const override;

  /// Of the tiles that the box meets.
  /// @throws as `for_each_cell`.
  void for_each_in(const Box3& box, const UseCell& use) const override;

  /// All leaves of the tiles that meet any of some boxes, each once.
  /// @throws as `for_each_cell`.
  std::vector<OccupancyCell> cells_of_tiles(std::span<const Box3> boxes) const;

  /// How many times a tile was read from its file.
  std::size_t tiles_read() const;

 private:
  struct Alive {
    const OccupancyTile* tile;
    std::shared_ptr<const OccupancyMap> map;
  };

  std::shared_ptr<const OccupancyMap> load(const OccupancyTile& tile) const;

  std::filesystem::path folder_;
  TilesIndex index_;
  mutable std::mutex mutex_;
  mutable std::list<Alive> alive_;  // the last used first
  mutable std::size_t tiles_read_ = 0;
};

/// An octree, or a folder of tiles, by what the path is.
/// @throws InputError if it is unusable.
std::unique_ptr<OccupancySource> open_occupancy(const std::filesystem::path& path);

}  // namespace roadbed::map::occupancy::octree
