#include "roadbed/map/occupancy/octree/merged_tree.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <numbers>

#include "roadbed/map/occupancy/octree/bt_writer.h"
#include "roadbed/map/occupancy/octree/cell_key.h"
#include "roadbed/map/occupancy/octree/compact_octree.h"
#include "roadbed/map/occupancy/octree/ot_writer.h"

namespace roadbed::map::inline occupancy::inline octree {
namespace {

constexpr std::int64_t kPieceSide = 1024;  // cells of the largest cubes that sources are asked for
constexpr std::size_t kMostLeaves = 100'000;  // of such a cube; of more, its eighths are asked for
constexpr std::int64_t kFilledSide = 8;
constexpr std::size_t kAny = std::numeric_limits<std::size_t>::max();
constexpr double kNothing = std::numeric_limits<double>::quiet_NaN();

bool do_meet(const CellBox& a, const CellBox& b) { return !a.cut(b).empty(); }
bool fills(const CellBox& box, const CellBox& cube) { return box.cut(cube) == cube; }

std::int64_t side_of(const CellBox& cube) { return cube.to[0] - cube.from[0]; }

// Place of a cell of a block in Morton order.
std::size_t place_in(const CellBox& block, std::int64_t x, std::int64_t y, std::int64_t z) {
  return morton(static_cast<std::uint32_t>(x - block.from[0]),
                static_cast<std::uint32_t>(y - block.from[1]),
                static_cast<std::uint32_t>(z - block.from[2]));
}

template <typename Use>
void for_each_cell(const CellBox& box, const Use& use) {
  for (std::int64_t z = box.from[2]; z < box.to[2]; ++z) {
    for (std::int64_t y = box.from[1]; y < box.to[1]; ++y) {
      for (std::int64_t x = box.from[0]; x < box.to[0]; ++x) use(x, y, z);
    }
  }
}

}  // namespace

MergedTree::MergedTree(std::span<const NamedOccupancy> sources, const MergeOptions& options,
                       const CellGrid& grid, const CellBox& wanted, const CellPlace& corner)
    : sources_(sources),
      options_(options),
      grid_(grid),
      resolution_m_(sources.front().occupancy->resolution_m()),
      wanted_(wanted),
      corner_(corner) {}

CellBox MergedTree::cube(const CellPlace& from, std::int64_t side) {
  return {from, {from[0] + side, from[1] + side, from[2] + side}};
}

CellBox MergedTree::child_of(const CellBox& cube, std::size_t child) {
  const std::int64_t half = side_of(cube) / 2;
  CellPlace from = cube.from;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    from[axis] += half * static_cast<std::int64_t>(child >> axis & 1u);
  }
  return MergedTree::cube(from, half);
}

// None if there are more than `most`.
std::optional<MergedTree::Leaves> MergedTree::leaves_in(const CellBox& cube,
                                                        std::size_t most) const {
  const CellBox wanted = wanted_.cut(cube);
  Box3 box = grid_.box_in_source(wanted);  // and a little less, that no neighbour is read
  box.min_in_source.array() += 0.25 * resolution_m_;
  box.max_in_source.array() -= 0.25 * resolution_m_;
  Leaves leaves;
  bool is_all = true;
  for (const NamedOccupancy& source : sources_) {
    source.occupancy->for_each_in(box, [&](const OccupancyCell& cell) {
      const CellBox cells = is_all ? grid_.cells_of(cell).cut(wanted) : CellBox{};
      if (cells.empty()) return;
      is_all = leaves.size() < most;
      leaves.push_back({cells, static_cast<double>(cell.log_odds)});
    });
    if (!is_all) return std::nullopt;
  }
  return leaves;
}

// A disc around the middles of all cells of a cube.
Stays MergedTree::stays_of(const CellBox& cube) const {
  if (!options_.part.in_plan) return Stays::all;
  const Eigen::Vector3d from = grid_.corner_in_source(cube.from),
                        to = grid_.corner_in_source(cube.to);
  const double side_m = resolution_m_ * static_cast<double>(side_of(cube) - 1);
  return options_.part.in_plan(0.5 * (from + to).head<2>(), side_m * std::numbers::sqrt2 / 2.0);
}

void MergedTree::add_to(double& sum, double log_odds) const {
  if (std::isnan(sum)) {
    sum = log_odds;
  } else {
    sum = options_.sticky_hits ? std::max(sum, log_odds) : sum + log_odds;
  }
}

float MergedTree::within_limits(double sum) const {
  const auto value = static_cast<float>(sum);
  return options_.sticky_hits ? value : std::clamp(value, rule_.least, rule_.most);
}

float MergedTree::joined(const Leaves& leaves) const {
  double sum = kNothing;
  for (const Leaf& leaf : leaves) add_to(sum, leaf.log_odds);
  return within_limits(sum);
}

std::array<float, 512> MergedTree::cells_of(const CellBox& block, const Leaves& leaves,
                                            Stays stays) const {
  std::array<double, 512> sums;
  sums.fill(kNothing);
  for (const Leaf& leaf : leaves) {
    for_each_cell(leaf.cells.cut(block), [&](std::int64_t x, std::int64_t y, std::int64_t z) {
      add_to(sums[place_in(block, x, y, z)], leaf.log_odds);
    });
  }
  if (stays == Stays::part) {
    for_each_cell({block.from, {block.to[0], block.to[1], block.from[2] + 1}},
                  [&](std::int64_t x, std::int64_t y, std::int64_t) {
                    if (stays_of(MergedTree::cube({x, y, block.from[2]}, 1)) == Stays::all) return;
                    for (std::int64_t z = block.from[2]; z < block.to[2]; ++z) {
                      sums[place_in(block, x, y, z)] = kNothing;
                    }
                  });
  }
  std::array<float, 512> values;
  std::ranges::transform(sums, values.begin(), [&](double sum) { return within_limits(sum); });
  return values;
}

/// Nodes as a writer has them.
template <typename Writer>
class MergedTree::Assembly {
 public:
  explicit Assembly(const MergedTree& tree) : tree_(tree) {}

  OctreeBytes run() {
    const Node root = node(cube(tree_.corner_, CompactOctree::kSide));
    return writer_.take(root);
  }

 private:
  using Node = typename Writer::Node;

  Node node(const CellBox& cube) {
    if (!do_meet(cube, tree_.wanted_)) return writer_.none();
    if (side_of(cube) <= kPieceSide) {
      const bool is_divided = side_of(cube) > kFilledSide;
      const auto leaves = tree_.leaves_in(cube, is_divided ? kMostLeaves : kAny);
      if (leaves) return part(cube, *leaves);
    }
    return writer_.node([&](std::size_t child) { return node(child_of(cube, child)); });
  }

  Node part(const CellBox& cube, const Leaves& leaves) {
    if (leaves.empty()) return writer_.none();
    const Stays stays = tree_.stays_of(cube);
    if (stays == Stays::nothing) return writer_.none();
    const auto fills_it = [&](const Leaf& leaf) { return fills(leaf.cells, cube); };
    if (stays == Stays::all && std::ranges::all_of(leaves, fills_it)) {
      return writer_.leaf(tree_.joined(leaves));
    }
    if (side_of(cube) == kFilledSide) return writer_.block(tree_.cells_of(cube, leaves, stays));
    return writer_.node([&](std::size_t child) {
      const CellBox below = child_of(cube, child);
      Leaves meet;
      std::ranges::copy_if(leaves, std::back_inserter(meet),
                           [&](const Leaf& leaf) { return do_meet(leaf.cells, below); });
      return part(below, meet);
    });
  }

  const MergedTree& tree_;
  Writer writer_;
};

OctreeBytes MergedTree::bt() const { return Assembly<BtWriter>(*this).run(); }

OctreeBytes MergedTree::ot() const { return Assembly<OtWriter>(*this).run(); }

}  // namespace roadbed::map::occupancy::octree
