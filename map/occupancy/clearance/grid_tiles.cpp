#include "roadbed/map/occupancy/clearance/grid_tiles.h"

#include <algorithm>
#include <utility>

namespace roadbed::map::inline occupancy::inline clearance {

GridTiles::GridTiles(std::int64_t side, std::size_t most_alive, Make make)
    : side_(side), most_alive_(most_alive), make_(std::move(make)) {}

std::shared_ptr<const PlanGrid> GridTiles::at(std::int64_t x, std::int64_t y) const {
  const std::int64_t tile_x = floor_div(x, side_), tile_y = floor_div(y, side_);
  const std::lock_guard lock(mutex_);
  const auto found = std::ranges::find_if(
      alive_, [&](const Tile& tile) { return tile.x == tile_x && tile.y == tile_y; });
  if (found != alive_.end()) {
    alive_.splice(alive_.begin(), alive_, found);
    return alive_.front().grid;
  }
  if (alive_.size() >= most_alive_) alive_.pop_back();
  const CellRange cells{tile_x * side_, tile_y * side_, (tile_x + 1) * side_, (tile_y + 1) * side_};
  alive_.push_front({tile_x, tile_y, make_(cells)});
  return alive_.front().grid;
}

}  // namespace roadbed::map::occupancy::clearance
