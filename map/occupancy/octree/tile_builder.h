#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <limits>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include "roadbed/map/occupancy/clouds/point_cloud.h"
#include "roadbed/map/occupancy/octree/occupancy_options.h"
#include "roadbed/map/occupancy/octree/occupancy_source.h"
#include "roadbed/map/occupancy/octree/tiles_index.h"

namespace roadbed::map::inline occupancy::inline octree {

class CloudMeasurements;

/// Cells a side of tiles that are at least so long: a power of two, so that no node of the octree
/// lies in two of them.
std::int64_t tile_side_cells(double side_m, double resolution_m);

/// Builds an occupancy in tiles from clouds that come one after the other. What they measure is
/// kept up to a bound of memory, then added to a file per tile; in the end each tile is put
/// together by itself. Where a cell is more than the hits and free cells of all clouds together,
/// each cloud is put aside by itself. The cells are those of `OccupancyMap::build`; the whole may
/// be larger than an octree's range, as every tile has an origin of its own.
class TileBuilder {
 public:
  struct Plan {
    std::string name = {};              ///< of the output, in messages
    std::filesystem::path folder = {};  ///< for files in between; they are removed in the end
    double resolution_m = 0.1;
    double carve_range_m = std::numeric_limits<double>::infinity();
    bool sticky_hits = true;  ///< and the next: as in OccupancyOptions
    int remove_seen_through = 0;
    Eigen::Vector3d origin_in_source{0, 0, 0};  ///< of `tree_origin`
    std::string crs;
    std::int64_t side_cells = 1024;       ///< of `tile_side_cells`
    std::size_t most_points = 0;          ///< of one cloud
    std::size_t most_bytes = 64'000'000;  ///< that cells take before they are put aside
  };

  explicit TileBuilder(Plan plan);
  ~TileBuilder();
  TileBuilder(const TileBuilder&) = delete;
  TileBuilder& operator=(const TileBuilder&) = delete;

  /// A cloud that is larger than an octree's range is taken in pieces, but for one scan by itself,
  /// and where clouds are kept apart one with a sensor.
  /// @throws InputError as `OccupancyMap::build` does, or if a file cannot be written.
  /// @throws std::invalid_argument if hits are not sticky and each point has its own sensor
  /// position.
  void add(const PointCloud& cloud);

  /// Hands out the bytes of each tile, in the order of the index that it returns.
  using Write = std::function<void(const std::string& file, std::string_view bytes)>;
  TilesIndex finish(const Write& write);

 private:
  using Place = std::pair<std::int64_t, std::int64_t>;  // y and x of a tile
  using Shift = std::array<std::int64_t, 3>;            // of cells, from the origin

  std::pair<double, double> cells_along(const Box3& box, int axis) const;
  Shift shift_of(const Box3& box) const;
  bool are_keys_enough(const Box3& box) const;
  bool may_be_cut(const PointCloud& cloud) const;
  void add_piece(const PointCloud& cloud, const Box3& box);
  void start(const Shift& shift);
  void spill();
  std::filesystem::path spill_file(const Place& place) const;
  OccupancyOptions options() const;
  std::optional<SeeThroughRemoval> seen_through(std::size_t removed) const;
  bool keeps_clouds_apart() const { return !plan_.sticky_hits || plan_.remove_seen_through > 0; }
  void make_tile(const Place& place, TilesIndex& index, const Write& write);

  Plan plan_;
  Shift shift_{};
  std::unique_ptr<CloudMeasurements> measured_;
  std::map<Place, std::size_t> spilled_blocks_;  // how many, by tile
  std::size_t removed_ = 0;
};

}  // namespace roadbed::map::occupancy::octree
