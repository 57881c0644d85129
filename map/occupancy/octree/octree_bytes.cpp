#include "roadbed/map/occupancy/octree/octree_bytes.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <span>
#include <vector>

#include "roadbed/map/files/visible_text.h"
#include "roadbed/map/occupancy/octree/bt_writer.h"
#include "roadbed/map/occupancy/octree/ot_writer.h"

namespace roadbed::map::inline occupancy::inline octree {
namespace {

using Regions = std::span<const CellBlocks::Placed>;

constexpr int kRegionDepth = 10;  // of 16; a region spans 64 cells

/// Puts together what the regions hold, from the root down. `Writer` makes nodes: `node(child)`
/// writes one whose i-th child is made by child(i), and says what became of it; `none()` is a node
/// that is not there, `block(b)` the node of a block.
template <typename Writer>
class Assembly {
 public:
  using Node = typename Writer::Node;

  explicit Assembly(Writer& writer) : writer_(writer) {}

  // Regions below one node, in order of their codes.
  Node make(const Regions& regions, int depth) {
    if (regions.empty()) return writer_.none();
    if (depth == kRegionDepth)
      return make(*regions.front().region, 0, regions.front().region->size());
    const int shift = 3 * (kRegionDepth - 1 - depth);
    auto from = regions.begin();
    return writer_.node([&](std::uint32_t i) {
      const auto to = std::find_if(from, regions.end(), [&](const CellBlocks::Placed& placed) {
        return (placed.code >> shift & 7u) != i;
      });
      const Regions part(from, to);
      from = to;
      return make(part, depth + 1);
    });
  }

 private:
  // Blocks `from` to `from` + `count` of a region.
  Node make(const BlockRegion& region, std::size_t from, std::size_t count) {
    if (count == 1) return region[from] == nullptr ? writer_.none() : writer_.block(*region[from]);
    const std::size_t part = count / 8;
    return writer_.node([&](std::size_t i) { return make(region, from + i * part, part); });
  }

  Writer& writer_;
};

template <typename Writer>
OctreeBytes written(const CellBlocks& blocks) {
  Writer writer;
  const std::vector<CellBlocks::Placed> regions = blocks.regions();
  const auto root = Assembly<Writer>(writer).make(regions, 0);
  return writer.take(root);
}

}  // namespace

std::string octree_header(OctreeForm form, const OctreeHeader& header) {
  const Eigen::Vector3d& origin = header.origin_in_source;
  const std::string seen_through =
      header.seen_through ? fmt::format("# roadbed seen-through {} removed {}\n",
                                        header.seen_through->clouds, header.seen_through->cells)
                          : "";
  return fmt::format(
      "# Octomap OcTree {}file\n# roadbed origin {} {} {} {}\n{}id OcTree\nsize {}\nres {}\n"
      "data\n",
      form == OctreeForm::bt ? "binary " : "", origin.x(), origin.y(), origin.z(),
      one_line(header.crs), seen_through, header.nodes, header.resolution_m);
}

OctreeBytes bt_data(const CellBlocks& blocks) { return written<BtWriter>(blocks); }

OctreeBytes ot_data(const CellBlocks& blocks) { return written<OtWriter>(blocks); }

}  // namespace roadbed::map::occupancy::octree
