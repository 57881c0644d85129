#pragma once

// Private to map/occupancy.

#include <Eigen/Core>
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

#include "roadbed/map/occupancy/octree/occupancy_source.h"

namespace roadbed::map::inline occupancy::inline octree {

/// The two forms of OctoMap's files.
enum class OctreeForm {
  bt,  ///< two bits a child: unknown, free, occupied, has children
  ot,  ///< log-odds and a byte of child flags a node
};

/// A `.bt` or `.ot` file whose header and data agree, so that its data can be read.
struct OctreeFile {
  OctreeForm form = OctreeForm::bt;
  double resolution_m = 0.0;
  std::size_t nodes = 0;
  Eigen::Vector3d origin_in_source{0, 0, 0};  ///< of a line `# roadbed origin X Y Z CRS`
  std::string crs;
  std::optional<SeeThroughRemoval>
      seen_through;       ///< of a line `# roadbed seen-through N removed M`
  std::string_view data;  ///< part of the bytes that were parsed
};

/// Whether the bytes begin as an OctoMap file does.
bool is_octree_file(std::string_view bytes);

/// Reads the header and walks over the data without building anything: depth at most 16, as many
/// nodes as the header says, no byte missing and none left over, log-odds finite. O(bytes), O(1)
/// memory.
/// @throws InputError naming the byte.
OctreeFile parse_octree_file(std::string_view bytes, const std::string& name);

}  // namespace roadbed::map::occupancy::octree
