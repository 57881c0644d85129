#pragma once

// Private to map/occupancy.

#include <cstdint>
#include <functional>
#include <list>
#include <memory>
#include <mutex>

#include "roadbed/map/occupancy/clearance/plan_grid.h"

namespace roadbed::map::inline occupancy::inline clearance {

/// Grids of a plane in square tiles, made when first asked for. Only the last ones are kept, as
/// many as `most_alive`; a tile that was dropped is made again. Threads may ask at the same time.
class GridTiles {
 public:
  using Make = std::function<std::shared_ptr<const PlanGrid>(const CellRange& tile)>;

  GridTiles(std::int64_t side, std::size_t most_alive, Make make);

  /// The grid of the tile that a cell lies in.
  std::shared_ptr<const PlanGrid> at(std::int64_t x, std::int64_t y) const;

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
