#pragma once

// Private to map/occupancy.

#include <algorithm>
#include <cstdint>
#include <functional>
#include <list>
#include <memory>
#include <mutex>
#include <utility>

#include "roadbed/map/occupancy/clearance/plan_grid.h"

namespace roadbed::map::inline occupancy::inline clearance {

/// Grids of a plane in square tiles, made when first asked for. Only the last ones are kept, as
/// many as `most_alive`; a tile that was dropped is made again. Threads may ask at the same time.
class GridTiles {
 public:
  using Make = std::function<std::shared_ptr<const PlanGrid>(const CellRange& tile)>;

  GridTiles(std::int64_t side, std::size_t most_alive, Make make)
      : side_(side), most_alive_(most_alive), make_(std::move(make)) {}

  /// The grid of the tile that a cell lies in.
  std::shared_ptr<const PlanGrid> at(std::int64_t x, std::int64_t y) const {
    const std::int64_t tile_x = floor_div(x, side_), tile_y = floor_div(y, side_);
    const std::lock_guard lock(mutex_);
    const auto found = std::ranges::find_if(
        alive_, [&](const Tile& tile) { return tile.x == tile_x && tile.y == tile_y; });
    if (found != alive_.end()) {
      alive_.splice(alive_.begin(), alive_, found);
      return alive_.front().grid;
    }
    if (alive_.size() >= most_alive_) alive_.pop_back();
    const CellRange cells{tile_x * side_, tile_y * side_, (tile_x + 1) * side_,
                          (tile_y + 1) * side_};
    alive_.push_front({tile_x, tile_y, make_(cells)});
    return alive_.front().grid;
  }

 private:
  struct Tile {
    std::int64_t x, y;
    std::shared_ptr<const PlanGrid> grid;
  };

  std::int64_t side_;
  std::size_t most_alive_;
  Make make_;
  mutable std::mutex mutex_;
  mutable std::list<Tile> alive_;  // the last used first
};

}  // namespace roadbed::map::occupancy::clearance
