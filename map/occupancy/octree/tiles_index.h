#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "roadbed/map/occupancy/clouds/point_cloud.h"
#include "roadbed/map/occupancy/octree/occupancy_source.h"

namespace roadbed::map::inline occupancy::inline octree {

/// One `.bt` of a tiled occupancy: all that was measured in a square of plan view.
struct OccupancyTile {
  std::int64_t x = 0, y = 0;  ///< its place, counted in tiles from the origin
  std::string file;           ///< beside the index
  std::size_t nodes = 0;
  std::string sha256;  ///< of its bytes, hexadecimal
  Box3 bounds;         ///< of its leaves, in source coordinates
};

/// What `index.json` in the folder of a tiled occupancy says. Tiles do not overlap: what a query
/// needs beyond one it takes from its neighbours.
struct TilesIndex {
  double resolution_m = 0.1;
  Eigen::Vector3d origin_in_source{0, 0, 0};  ///< cells are counted from here
  std::string crs;
  std::int64_t side_cells = 0;  ///< of a tile, a power of two
  std::vector<OccupancyTile> tiles;
  std::optional<SeeThroughRemoval> seen_through = {};  ///< of all tiles

  double side_m() const { return resolution_m * static_cast<double>(side_cells); }
};

/// "tile_3_-1.bt"
std::string tile_file_name(std::int64_t x, std::int64_t y);

/// Whether a file may be one of these.
bool is_tile_file_name(const std::string& name);

std::string write_tiles_index(const TilesIndex& index);

/// @throws InputError naming what is wrong. `name` stands for the file in messages.
TilesIndex parse_tiles_index(std::string_view bytes, const std::string& name);

/// The index in a folder.
std::filesystem::path tiles_index_file(const std::filesystem::path& folder);

/// Whether a path is a folder with an index.
bool is_tiled_occupancy(const std::filesystem::path& path);

}  // namespace roadbed::map::occupancy::octree
