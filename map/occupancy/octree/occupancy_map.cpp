#include "roadbed/map/occupancy/octree/occupancy_map.h"

#include <cstdint>
#include <mutex>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "roadbed/map/files/input_error.h"
#include "roadbed/map/files/read_file.h"
#include "roadbed/map/occupancy/clouds/log_clouds.h"
#include "roadbed/map/occupancy/clouds/read_point_cloud.h"
#include "roadbed/map/occupancy/octree/cloud_measurements.h"
#include "roadbed/map/occupancy/octree/compact_octree.h"
#include "roadbed/map/occupancy/octree/octree_file.h"

namespace roadbed::map::inline occupancy::inline octree {

struct OccupancyMap::Tree {
  double resolution_m;
  CompactOctree octree;
  std::size_t nodes = 0;
  Eigen::Vector3d origin_in_source{0, 0, 0};
  std::string crs;
  std::optional<SeeThroughRemoval> seen_through;
  std::once_flag bounded;  // of the bounds, for which all leaves are looked at
  std::optional<Box3> bounds;

  explicit Tree(double cell_m) : resolution_m(cell_m) {}

  std::string file(OctreeForm form, const OctreeBytes& bytes) const {
    return octree_header(form, {resolution_m, bytes.nodes, origin_in_source, crs, seen_through}) +
           bytes.data;
  }

  // As OctoMap computes it, whose bits others compare.
  OccupancyCell cell_of(const CompactOctree::Leaf& leaf) const {
    const double side = leaf.side, size_m = resolution_m * side;
    const auto middle = [&](std::uint32_t least) {
      return ((static_cast<double>(least) - kHalfRange) / side + 0.5) * size_m;
    };
    return {origin_in_source + Eigen::Vector3d(middle(leaf.least[0]), middle(leaf.least[1]),
                                               middle(leaf.least[2])),
            size_m, leaf.state, leaf.log_odds};
  }
};

namespace {

// The key of a point's cell, or of the nearest one in range.
CellKey key_around(const Eigen::Vector3d& in_tree, double resolution_m) {
  const Eigen::Array3d cells =
      (in_tree.array() / resolution_m).floor().max(-kHalfRange).min(kHalfRange - 1.0) + kHalfRange;
  return {static_cast<std::uint16_t>(cells.x()), static_cast<std::uint16_t>(cells.y()),
          static_cast<std::uint16_t>(cells.z())};
}

std::optional<SeeThroughRemoval> seen_through_of(const OccupancyOptions& options,
                                                 const CloudMeasurements& cells) {
  if (options.remove_seen_through == 0) return std::nullopt;
  return SeeThroughRemoval{options.remove_seen_through, cells.removed()};
}

CloudsInTurn in_turn(std::span<const PointCloud> clouds) {
  return [clouds](const std::function<void(const PointCloud&)>& use) {
    for (const PointCloud& cloud : clouds) use(cloud);
  };
}

CompactOctree octree_of(OctreeForm form, std::string_view data, std::size_t nodes) {
  if (nodes == 0) return {};
  return form == OctreeForm::bt ? CompactOctree::of_bt(data) : CompactOctree::of_ot(data);
}

}  // namespace

OccupancyMap::OccupancyMap(std::unique_ptr<Tree> tree) : tree_(std::move(tree)) {}
OccupancyMap::~OccupancyMap() = default;
OccupancyMap::OccupancyMap(OccupancyMap&&) noexcept = default;
OccupancyMap& OccupancyMap::operator=(OccupancyMap&&) noexcept = default;

OccupancyMap OccupancyMap::build(std::span<const PointCloud> clouds,
                                 const OccupancyOptions& options) {
  return build(in_turn(clouds), options);
}

OccupancyMap OccupancyMap::build(const CloudsInTurn& clouds, const OccupancyOptions& options) {
  MeasuredClouds measured = measure_clouds(clouds, options);
  auto tree = std::make_unique<Tree>(options.resolution_m);
  tree->crs = measured.crs;
  tree->origin_in_source = measured.origin_in_source;
  const OctreeBytes bytes = options.sticky_hits ? measured.cells.bt() : measured.cells.ot();
  tree->seen_through = seen_through_of(options, measured.cells);
  tree->octree =
      octree_of(options.sticky_hits ? OctreeForm::bt : OctreeForm::ot, bytes.data, bytes.nodes);
  tree->nodes = bytes.nodes;
  return OccupancyMap(std::move(tree));
}

OccupancyMap::File OccupancyMap::build_bt(std::span<const PointCloud> clouds,
                                          const OccupancyOptions& options) {
  return build_bt(in_turn(clouds), options);
}

OccupancyMap::File OccupancyMap::build_bt(const CloudsInTurn& clouds,
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
  return parse(read_file(file, most_unpacked_of_rows), input_name(file));
}

OccupancyMap OccupancyMap::parse(std::string_view bytes, const std::string& name) {
  const OctreeFile file = parse_octree_file(bytes, name);
  auto tree = std::make_unique<Tree>(file.resolution_m);
  tree->origin_in_source = file.origin_in_source;
  tree->crs = file.crs;
  tree->seen_through = file.seen_through;
  tree->octree = octree_of(file.form, file.data, file.nodes);
  tree->nodes = file.nodes;
  return OccupancyMap(std::move(tree));
}

double OccupancyMap::resolution_m() const { return tree_->resolution_m; }
const Eigen::Vector3d& OccupancyMap::origin_in_source() const { return tree_->origin_in_source; }
const std::string& OccupancyMap::crs() const { return tree_->crs; }
std::optional<SeeThroughRemoval> OccupancyMap::seen_through() const { return tree_->seen_through; }
std::size_t OccupancyMap::node_count() const { return tree_->nodes; }

CellState OccupancyMap::at(const Eigen::Vector3d& in_source) const {
  const auto key = key_at(in_source - tree_->origin_in_source, resolution_m());
  return key ? tree_->octree.at(*key) : CellState::unknown;
}

void OccupancyMap::for_each_cell(const UseCell& use) const {
  tree_->octree.for_each({}, [&](const CompactOctree::Leaf& leaf) { use(tree_->cell_of(leaf)); });
}

void OccupancyMap::for_each_in(const Box3& box, const UseCell& use) const {
  const Eigen::Vector3d& origin = tree_->origin_in_source;
  tree_->octree.for_each({key_around(box.min_in_source - origin, resolution_m()),
                          key_around(box.max_in_source - origin, resolution_m())},
                         [&](const CompactOctree::Leaf& leaf) { use(tree_->cell_of(leaf)); });
}

std::optional<Box3> OccupancyMap::bounds() const {
  std::call_once(tree_->bounded, [&] {
    std::optional<Box3>& box = tree_->bounds;
    for_each_cell([&](const OccupancyCell& cell) {
      const Eigen::Vector3d least = cell.centre_in_source.array() - 0.5 * cell.size_m;
      const Eigen::Vector3d most = cell.centre_in_source.array() + 0.5 * cell.size_m;
      if (!box) box = Box3{least, most};
      box = Box3{box->min_in_source.cwiseMin(least), box->max_in_source.cwiseMax(most)};
    });
  });
  return tree_->bounds;
}

std::string OccupancyMap::to_bt() const { return tree_->file(OctreeForm::bt, tree_->octree.bt()); }

std::string OccupancyMap::to_ot() const { return tree_->file(OctreeForm::ot, tree_->octree.ot()); }

bool is_occupancy_file(std::string_view bytes) { return is_octree_file(bytes); }

namespace {

void check_is_any_left(bool is_any_left, const std::filesystem::path& first) {
  if (is_any_left) return;
  throw InputError({.file = input_name(first),
                    .found = "no point of the clouds is left",
                    .needed = "at least one",
                    .remedy = "filter less"});
}

}  // namespace

void refuse_to_filter(const std::string& name) {
  throw InputError({.file = name,
                    .found = "is an octree, whose points are no longer known",
                    .needed = "point clouds, to say which points count",
                    .remedy = "give the clouds, or leave the filter out"});
}

OccupancyMap load_occupancy_of_log(const std::filesystem::path& log, const CloudFilter& filter) {
  const LogClouds clouds(log, {});
  bool is_any_left = false;
  return OccupancyMap::build(CloudsInTurn([&](const std::function<void(const PointCloud&)>& use) {
                               clouds.for_each(
                                   [&](PointCloud cloud) {
                                     cloud = within_reach(std::move(cloud), filter);
                                     if (cloud.points.empty()) return;
                                     is_any_left = true;
                                     use(cloud);
                                   },
                                   filter);
                               check_is_any_left(is_any_left, log);
                             }),
                             OccupancyOptions{});
}

OccupancyMap load_occupancy(std::span<const std::filesystem::path> files,
                            const OccupancyOptions& options, const CloudFilter& filter) {
  std::vector<PointCloud> clouds;
  for (const std::filesystem::path& file : files) {
    const std::string bytes = read_file(file, most_unpacked_of_rows);
    if (!is_occupancy_file(bytes)) {
      PointCloud cloud = point_cloud_of(file, bytes, filter);
      check_is_in_metres(cloud);
      cloud = within_reach(std::move(cloud), filter);
      if (!cloud.points.empty()) clouds.push_back(std::move(cloud));
    } else if (!filter.keeps_all()) {
      refuse_to_filter(input_name(file));
    } else if (files.size() == 1) {
      return OccupancyMap::parse(bytes, input_name(file));
    } else {
      throw InputError({.file = input_name(file),
                        .found = "is an octree beside other files",
                        .needed = "one octree alone, or point clouds",
                        .remedy = "give the clouds that the octree was built from"});
    }
  }
  if (!files.empty()) check_is_any_left(!clouds.empty(), files.front());
  return OccupancyMap::build(clouds, options);
}

}  // namespace roadbed::map::occupancy::octree
