#pragma once

// Private to map/occupancy.

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <string_view>

#include "roadbed/map/occupancy/octree/octree_bytes.h"
#include "roadbed/map/occupancy/octree/tiles_index.h"

namespace roadbed::map::inline occupancy::inline octree {

/// Hands out the bytes of a tile, and adds it to the index, whose frame it has.
/// @param data  of a `.bt` whose origin is the tile's corner; of at least one leaf.
void add_tile(TilesIndex& index, std::int64_t x, std::int64_t y, const OctreeBytes& data,
              const std::optional<SeeThroughRemoval>& seen_through,
              const std::function<void(const std::string& file, std::string_view bytes)>& write);

}  // namespace roadbed::map::occupancy::octree
