#pragma once

// Private to map/occupancy.

#include <cstddef>
#include <string>

namespace roadbed::map::inline occupancy::inline octree {

/// The data of an OctoMap file, as it follows its header.
struct OctreeBytes {
  std::string data;
  std::size_t nodes = 0;
};

}  // namespace roadbed::map::occupancy::octree
