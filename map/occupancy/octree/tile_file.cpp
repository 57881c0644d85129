#include "roadbed/map/occupancy/octree/tile_file.h"

#include "roadbed/map/files/sha256.h"
#include "roadbed/map/occupancy/octree/occupancy_map.h"

namespace roadbed::map::inline occupancy::inline octree {

void add_tile(TilesIndex& index, std::int64_t x, std::int64_t y, const OctreeBytes& data,
              const std::optional<SeeThroughRemoval>& seen_through,
              const std::function<void(const std::string& file, std::string_view bytes)>& write) {
  const Eigen::Vector3d corner(static_cast<double>(x * index.side_cells),
                               static_cast<double>(y * index.side_cells), 0.0);
  const std::string bytes =
      octree_header(OctreeForm::bt,
                    {.resolution_m = index.resolution_m,
                     .nodes = data.nodes,
                     .origin_in_source = index.origin_in_source + index.resolution_m * corner,
                     .crs = index.crs,
                     .seen_through = seen_through}) +
      data.data;
  OccupancyTile tile{.x = x,
                     .y = y,
                     .file = tile_file_name(x, y),
                     .nodes = data.nodes,
                     .sha256 = sha256_of_bytes(bytes),
                     .bounds = {}};
  tile.bounds = *OccupancyMap::parse(bytes, tile.file).bounds();
  write(tile.file, bytes);
  index.tiles.push_back(std::move(tile));
}

}  // namespace roadbed::map::occupancy::octree
