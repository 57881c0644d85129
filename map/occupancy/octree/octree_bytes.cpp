#include "roadbed/map/occupancy/octree/octree_bytes.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "roadbed/map/files/visible_text.h"
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

// The bits of a byte, each followed by a zero.
constexpr std::array<std::uint16_t, 256> kApart = [] {
  std::array<std::uint16_t, 256> apart{};
  for (unsigned byte = 0; byte < 256; ++byte) {
    for (unsigned bit = 0; bit < 8; ++bit) {
      apart[byte] = static_cast<std::uint16_t>(apart[byte] | (byte >> bit & 1u) << 2 * bit);
    }
  }
  return apart;
}();

class BtWriter {
 public:
  using Node = BtPair;

  static Node none() { return BtPair::unknown; }

  // Two bytes say which children there are; the children's own follow.
  template <typename Child>
  Node node(const Child& child) {
    const std::size_t at = bytes_.data.size();
    bytes_.data.append(2, '\0');
    unsigned pairs = 0;
    for (unsigned i = 0; i < 8; ++i) pairs |= static_cast<unsigned>(child(i)) << 2 * i;
    return close(at, pairs);
  }

  Node block(const CellBlock& block) {
    return node([&](unsigned i) { return word(block.hit[i], block.free[i] & ~block.hit[i]); });
  }

  OctreeBytes take() {
    bytes_.nodes += !bytes_.data.empty();  // the root
    return std::move(bytes_);
  }

 private:
  Node word(std::uint64_t hit, std::uint64_t free) {
    if ((hit | free) == 0) return BtPair::unknown;
    if (hit == ~std::uint64_t{0}) return BtPair::occupied;
    if (free == ~std::uint64_t{0}) return BtPair::free;
    return node([&](unsigned i) { return leaves(hit >> 8 * i & 0xffu, free >> 8 * i & 0xffu); });
  }

  Node leaves(std::uint64_t hit, std::uint64_t free) {
    const std::size_t at = bytes_.data.size();
    bytes_.data.append(2, '\0');
    return close(at, kApart[free] | static_cast<unsigned>(kApart[hit]) << 1);
  }

  Node close(std::size_t at, unsigned pairs) {
    if (pairs == 0 || pairs == kAllFree || pairs == kAllOccupied) {
      bytes_.data.resize(at);
      return pair_of(pairs, 0);
    }
    bytes_.data[at] = static_cast<char>(pairs & 0xffu);
    bytes_.data[at + 1] = static_cast<char>(pairs >> 8);
    for (; pairs != 0; pairs >>= 2) bytes_.nodes += (pairs & 3u) != 0;
    return BtPair::inner;
  }

  OctreeBytes bytes_;
};

template <typename Writer>
OctreeBytes written(const CellBlocks& blocks) {
  Writer writer;
  const std::vector<CellBlocks::Placed> regions = blocks.regions();
  Assembly<Writer>(writer).make(regions, 0);
  return writer.take();
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
