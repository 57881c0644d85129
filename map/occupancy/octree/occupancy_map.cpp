#include "roadbed/map/occupancy/octree/occupancy_map.h"

#include <fmt/format.h>
#include <octomap/octomap.h>

#include <mutex>
#include <optional>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "roadbed/map/files/input_error.h"
#include "roadbed/map/files/read_file.h"
#include "roadbed/map/occupancy/clouds/read_point_cloud.h"
#include "roadbed/map/occupancy/octree/cloud_measurements.h"
#include "roadbed/map/occupancy/octree/octree_file.h"

namespace roadbed::map::inline occupancy::inline octree {

struct OccupancyMap::Tree {
  octomap::OcTree octree;
  Eigen::Vector3d origin_in_source{0, 0, 0};
  std::string crs;
  std::optional<SeeThroughRemoval> seen_through;
  std::once_flag bounded;  // of the bounds, for which all leaves are looked at
  std::optional<Box3> bounds;

  explicit Tree(double resolution_m) : octree(resolution_m) {}

  OctreeHeader header(std::size_t nodes) const {
    return {octree.getResolution(), nodes, origin_in_source, crs, seen_through};
  }
};

namespace {

octomap::OcTreeKey octomap_key(const CellKey& key) { return {key[0], key[1], key[2]}; }

// The key of a point's cell, or of the nearest one in range.
octomap::OcTreeKey key_around(const Eigen::Vector3d& in_tree, double resolution_m) {
  const Eigen::Array3d cells =
      (in_tree.array() / resolution_m).floor().max(-kHalfRange).min(kHalfRange - 1.0) + kHalfRange;
  return {static_cast<std::uint16_t>(cells.x()), static_cast<std::uint16_t>(cells.y()),
          static_cast<std::uint16_t>(cells.z())};
}

template <typename Leaf>
OccupancyCell cell_of(const octomap::OcTree& octree, const Leaf& leaf,
                      const Eigen::Vector3d& origin_in_source) {
  return {origin_in_source + Eigen::Vector3d(leaf.getX(), leaf.getY(), leaf.getZ()), leaf.getSize(),
          octree.isNodeOccupied(*leaf) ? CellState::occupied : CellState::free};
}

std::optional<SeeThroughRemoval> seen_through_of(const OccupancyOptions& options,
                                                 const CloudMeasurements& cells) {
  if (options.remove_seen_through == 0) return std::nullopt;
  return SeeThroughRemoval{options.remove_seen_through, cells.removed()};
}

}  // namespace

OccupancyMap::OccupancyMap(std::unique_ptr<Tree> tree) : tree_(std::move(tree)) {}
OccupancyMap::~OccupancyMap() = default;
OccupancyMap::OccupancyMap(OccupancyMap&&) noexcept = default;
OccupancyMap& OccupancyMap::operator=(OccupancyMap&&) noexcept = default;

OccupancyMap OccupancyMap::build(std::span<const PointCloud> clouds,
                                 const OccupancyOptions& options) {
  MeasuredClouds measured = measure_clouds(clouds, options);
  auto tree = std::make_unique<Tree>(options.resolution_m);
  tree->crs = measured.crs;
  tree->origin_in_source = measured.origin_in_source;
  OctreeBytes bytes = options.sticky_hits ? measured.cells.bt() : measured.cells.ot();
  tree->seen_through = seen_through_of(options, measured.cells);
  if (bytes.nodes > 0) {
    std::istringstream data{std::move(bytes.data)};
    if (options.sticky_hits) {
      tree->octree.readBinaryData(data);
    } else {
      tree->octree.readData(data);
    }
  }
  return OccupancyMap(std::move(tree));
}

OccupancyMap::File OccupancyMap::build_bt(std::span<const PointCloud> clouds,
                                          const OccupancyOptions& options) {
  MeasuredClouds measured = measure_clouds(clouds, options);
  const OctreeBytes bytes = measured.cells.bt();
  const auto seen_through = seen_through_of(options, measured.cells);
  return {octree_header(OctreeForm::bt, {.resolution_m = options.resolution_m,
                                         .nodes = bytes.nodes,
                                         .origin_in_source = measured.origin_in_source,
                                         .crs = measured.crs,
                                         .seen_through = seen_through}) +
              bytes.data,
          bytes.nodes, seen_through};
}

OccupancyMap OccupancyMap::load(const std::filesystem::path& file) {
  return parse(read_file(file), input_name(file));
}

OccupancyMap OccupancyMap::parse(std::string_view bytes, const std::string& name) {
  const OctreeFile file = parse_octree_file(bytes, name);
  auto tree = std::make_unique<Tree>(file.resolution_m);
  tree->origin_in_source = file.origin_in_source;
  tree->crs = file.crs;
  tree->seen_through = file.seen_through;
  if (file.nodes > 0) {
    std::istringstream data{std::string(file.data)};
    if (file.form == OctreeForm::bt) {
      tree->octree.readBinaryData(data);
    } else {
      tree->octree.readData(data);
      tree->octree.toMaxLikelihood();
    }
  }
  return OccupancyMap(std::move(tree));
}

double OccupancyMap::resolution_m() const { return tree_->octree.getResolution(); }
const Eigen::Vector3d& OccupancyMap::origin_in_source() const { return tree_->origin_in_source; }
const std::string& OccupancyMap::crs() const { return tree_->crs; }
std::optional<SeeThroughRemoval> OccupancyMap::seen_through() const { return tree_->seen_through; }
std::size_t OccupancyMap::node_count() const { return tree_->octree.size(); }

CellState OccupancyMap::at(const Eigen::Vector3d& in_source) const {
  const auto key = key_at(in_source - tree_->origin_in_source, resolution_m());
  if (!key) return CellState::unknown;
  const octomap::OcTreeNode* node = tree_->octree.search(octomap_key(*key));
  if (node == nullptr) return CellState::unknown;
  return tree_->octree.isNodeOccupied(node) ? CellState::occupied : CellState::free;
}

std::vector<OccupancyCell> OccupancyMap::cells() const {
  const octomap::OcTree& octree = tree_->octree;
  std::vector<OccupancyCell> cells;
  for (auto leaf = octree.begin_leafs(), end = octree.end_leafs(); leaf != end; ++leaf) {
    cells.push_back(cell_of(octree, leaf, tree_->origin_in_source));
  }
  return cells;
}

std::vector<OccupancyCell> OccupancyMap::cells_in(const Box3& box) const {
  const octomap::OcTree& octree = tree_->octree;
  std::vector<OccupancyCell> cells;
  if (octree.size() == 0) return cells;  // its iterator needs a root
  const auto from = key_around(box.min_in_source - tree_->origin_in_source, resolution_m());
  const auto to = key_around(box.max_in_source - tree_->origin_in_source, resolution_m());
  for (auto leaf = octree.begin_leafs_bbx(from, to), end = octree.end_leafs_bbx(); leaf != end;
       ++leaf) {
    cells.push_back(cell_of(octree, leaf, tree_->origin_in_source));
  }
  return cells;
}

std::optional<Box3> OccupancyMap::bounds() const {
  std::call_once(tree_->bounded, [&] {
    std::optional<Box3>& box = tree_->bounds;
    for (const OccupancyCell& cell : cells()) {
      const Eigen::Vector3d least = cell.centre_in_source.array() - 0.5 * cell.size_m;
      const Eigen::Vector3d most = cell.centre_in_source.array() + 0.5 * cell.size_m;
      if (!box) box = Box3{least, most};
      box = Box3{box->min_in_source.cwiseMin(least), box->max_in_source.cwiseMax(most)};
    }
  });
  return tree_->bounds;
}

std::string OccupancyMap::to_bt() const {
  octomap::OcTree judged(tree_->octree);
  judged.toMaxLikelihood();
  judged.prune();
  std::ostringstream out;
  out << octree_header(OctreeForm::bt, tree_->header(judged.size()));
  if (judged.size() > 0) judged.writeBinaryData(out);
  return std::move(out).str();
}

std::string OccupancyMap::to_ot() const {
  std::ostringstream out;
  out << octree_header(OctreeForm::ot, tree_->header(tree_->octree.size()));
  if (tree_->octree.size() > 0) tree_->octree.writeData(out);
  return std::move(out).str();
}

bool is_occupancy_file(std::string_view bytes) { return is_octree_file(bytes); }

OccupancyMap load_occupancy(std::span<const std::filesystem::path> files,
                            const OccupancyOptions& options) {
  std::vector<PointCloud> clouds;
  for (const std::filesystem::path& file : files) {
    const std::string bytes = read_file(file);
    if (!is_occupancy_file(bytes)) {
      clouds.push_back(parse_point_cloud(bytes, input_name(file)));
      check_is_in_metres(clouds.back());
    } else if (files.size() == 1) {
      return OccupancyMap::parse(bytes, input_name(file));
    } else {
      throw InputError({.file = input_name(file),
                        .found = "is an octree beside other files",
                        .needed = "one octree alone, or point clouds",
                        .remedy = "give the clouds that the octree was built from"});
    }
  }
  return OccupancyMap::build(clouds, options);
}

}  // namespace roadbed::map::occupancy::octree
