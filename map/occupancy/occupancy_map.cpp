#include "roadbed/map/occupancy/occupancy_map.h"

#include <fmt/format.h>
#include <octomap/octomap.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <sstream>
#include <stdexcept>
#include <utility>

#include "roadbed/map/input_error.h"
#include "roadbed/map/occupancy/cell_set.h"
#include "roadbed/map/occupancy/octree_file.h"
#include "roadbed/map/read_file.h"

namespace roadbed::map {

struct OccupancyMap::Tree {
  octomap::OcTree octree;
  Eigen::Vector3d origin_in_source{0, 0, 0};
  std::string crs;

  explicit Tree(double resolution_m) : octree(resolution_m) {}
};

namespace {

constexpr double kHalfRange = 32768.0;           // cells on either side of the origin
constexpr std::size_t kMostBlocks = 24'000'000;  // of free space: some 2.4 GB

std::optional<CellKey> key_at(const Eigen::Vector3d& in_tree, double resolution_m) {
  const Eigen::Array3d cells = (in_tree.array() * (1.0 / resolution_m)).floor() + kHalfRange;
  if (!((cells >= 0.0).all() && (cells < 2.0 * kHalfRange).all())) return std::nullopt;
  return CellKey{static_cast<std::uint16_t>(cells.x()), static_cast<std::uint16_t>(cells.y()),
                 static_cast<std::uint16_t>(cells.z())};
}

octomap::OcTreeKey octomap_key(const CellKey& key) { return {key[0], key[1], key[2]}; }

Eigen::Vector3d centre_in_tree(const octomap::OcTree& octree, const octomap::OcTreeKey& key,
                               unsigned depth) {
  return {octree.keyToCoord(key[0], depth), octree.keyToCoord(key[1], depth),
          octree.keyToCoord(key[2], depth)};
}

// Where the octree's range allows it, the source's own origin; else the middle of all points.
Eigen::Vector3d choose_origin(std::span<const PointCloud> clouds, double resolution_m) {
  Box3 all = bounds(clouds.front());
  for (const PointCloud& cloud : clouds.subspan(1)) {
    const Box3 box = bounds(cloud);
    all.min_in_source = all.min_in_source.cwiseMin(box.min_in_source);
    all.max_in_source = all.max_in_source.cwiseMax(box.max_in_source);
  }
  constexpr double near_zero_m = 4096.0;  // OctoMap computes in float
  const double range_m = std::min(near_zero_m, (kHalfRange - 1.0) * resolution_m);
  Eigen::Vector3d origin(0, 0, 0);
  for (int axis = 0; axis < 3; ++axis) {
    const double from = all.min_in_source[axis], to = all.max_in_source[axis];
    if (std::max(-from, to) > range_m) origin[axis] = std::round(0.5 * (from + to));
  }
  return origin;
}

/// Collects what clouds measured, cell by cell.
class Measurements {
 public:
  Measurements(const Eigen::Vector3d& origin_in_source, const OccupancyOptions& options)
      : origin_in_source_(origin_in_source), options_(options), rays_(options.resolution_m) {}

  void add(const PointCloud& cloud) {
    CellSet ends;
    for (std::size_t i = 0; i < cloud.points.size(); ++i) {
      const CellKey end = checked_key(cloud, "point", cloud.in_source(i));
      hits_.insert(end);
      if (cloud.sensor_in_source) ends.insert(end);
    }
    if (!cloud.sensor_in_source) return;
    checked_key(cloud, "sensor", *cloud.sensor_in_source);
    const Eigen::Vector3d sensor_in_tree = *cloud.sensor_in_source - origin_in_source_;
    ends.for_each([&](const CellKey& end) { carve(cloud, sensor_in_tree, end); });
  }

  /// Hits come last: whatever was carved, they stay.
  void mark(octomap::OcTree& octree) const {
    const auto mark_all = [&octree](const CellSet& cells, float log_odds) {
      cells.for_each(
          [&](const CellKey& key) { octree.setNodeValue(octomap_key(key), log_odds, true); });
    };
    mark_all(free_, octree.getClampingThresMinLog());
    mark_all(hits_, octree.getClampingThresMaxLog());
    octree.updateInnerOccupancy();
    octree.prune();
  }

 private:
  CellKey checked_key(const PointCloud& cloud, const char* what,
                      const Eigen::Vector3d& in_source) const {
    const auto key = key_at(in_source - origin_in_source_, options_.resolution_m);
    if (key) return *key;
    throw InputError({.file = cloud.name,
                      .place = {},
                      .element = fmt::format("{} ({}, {}, {})", what, in_source.x(), in_source.y(),
                                             in_source.z()),
                      .found = fmt::format("lies more than {} cells of {} m from the middle",
                                           kHalfRange, options_.resolution_m),
                      .needed = {},
                      .remedy = "take a coarser resolution, or cut the cloud"});
  }

  void carve(const PointCloud& cloud, const Eigen::Vector3d& sensor_in_tree, const CellKey& end) {
    Eigen::Vector3d end_in_tree = centre_in_tree(rays_, octomap_key(end), rays_.getTreeDepth());
    const double length_m = (end_in_tree - sensor_in_tree).norm();
    if (length_m > options_.carve_range_m) {
      end_in_tree =
          sensor_in_tree + (end_in_tree - sensor_in_tree) * (options_.carve_range_m / length_m);
    }
    rays_.computeRayKeys(octomap_point(sensor_in_tree), octomap_point(end_in_tree), ray_);
    for (const octomap::OcTreeKey& key : ray_) free_.insert({key[0], key[1], key[2]});
    if (free_.block_count() > kMostBlocks) {
      throw InputError({.file = cloud.name,
                        .place = {},
                        .element = "rays",
                        .found = "cross more cells than can be kept",
                        .needed = {},
                        .remedy = "take a coarser resolution or a shorter carving range"});
    }
  }

  static octomap::point3d octomap_point(const Eigen::Vector3d& point) {
    return {static_cast<float>(point.x()), static_cast<float>(point.y()),
            static_cast<float>(point.z())};
  }

  Eigen::Vector3d origin_in_source_;
  OccupancyOptions options_;
  octomap::OcTree rays_;  // stays empty: it only turns rays into keys
  octomap::KeyRay ray_;
  CellSet hits_, free_;
};

void check(std::span<const PointCloud> clouds, const OccupancyOptions& options) {
  if (!(options.resolution_m > 0.0) || !std::isfinite(options.resolution_m)) {
    throw std::invalid_argument(
        fmt::format("OccupancyMap: resolution must be positive, got {} m", options.resolution_m));
  }
  if (!(options.carve_range_m > 0.0)) {
    throw std::invalid_argument(fmt::format(
        "OccupancyMap: carving range must be positive, got {} m", options.carve_range_m));
  }
  const bool all_hold_points = std::all_of(clouds.begin(), clouds.end(),
                                           [](const PointCloud& c) { return !c.points.empty(); });
  if (clouds.empty() || !all_hold_points) {
    throw std::invalid_argument("OccupancyMap: every cloud needs at least 1 point");
  }
}

std::string common_crs(std::span<const PointCloud> clouds) {
  for (const PointCloud& cloud : clouds) {
    if (cloud.crs != clouds.front().crs) {
      throw InputError(
          {.file = cloud.name,
           .place = {},
           .element = "CRS",
           .found = fmt::format("\"{}\"", cloud.crs),
           .needed = fmt::format("\"{}\" as {} has", clouds.front().crs, clouds.front().name),
           .remedy = "bring the clouds into one frame first"});
    }
  }
  return clouds.front().crs;
}

std::string on_one_line(std::string text) {
  std::replace_if(
      text.begin(), text.end(), [](char c) { return static_cast<unsigned char>(c) < 0x20; }, ' ');
  return text;
}

}  // namespace

OccupancyMap::OccupancyMap(std::unique_ptr<Tree> tree) : tree_(std::move(tree)) {}
OccupancyMap::~OccupancyMap() = default;
OccupancyMap::OccupancyMap(OccupancyMap&&) noexcept = default;
OccupancyMap& OccupancyMap::operator=(OccupancyMap&&) noexcept = default;

OccupancyMap OccupancyMap::build(std::span<const PointCloud> clouds,
                                 const OccupancyOptions& options) {
  check(clouds, options);
  auto tree = std::make_unique<Tree>(options.resolution_m);
  tree->crs = common_crs(clouds);
  tree->origin_in_source = choose_origin(clouds, options.resolution_m);
  Measurements measurements(tree->origin_in_source, options);
  for (const PointCloud& cloud : clouds) measurements.add(cloud);
  measurements.mark(tree->octree);
  return OccupancyMap(std::move(tree));
}

OccupancyMap OccupancyMap::load(const std::filesystem::path& file) {
  return parse(read_file(file), file.string());
}

OccupancyMap OccupancyMap::parse(std::string_view bytes, const std::string& name) {
  const OctreeFile file = parse_octree_file(bytes, name);
  auto tree = std::make_unique<Tree>(file.resolution_m);
  tree->origin_in_source = file.origin_in_source;
  tree->crs = file.crs;
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
    cells.push_back(
        {tree_->origin_in_source + centre_in_tree(octree, leaf.getKey(), leaf.getDepth()),
         leaf.getSize(), octree.isNodeOccupied(*leaf) ? CellState::occupied : CellState::free});
  }
  return cells;
}

std::string OccupancyMap::to_bt() const {
  octomap::OcTree pruned(tree_->octree);
  pruned.prune();
  const Eigen::Vector3d& origin = tree_->origin_in_source;
  std::ostringstream out;
  out << "# Octomap OcTree binary file\n"
      << fmt::format("# roadbed origin {} {} {} {}\n", origin.x(), origin.y(), origin.z(),
                     on_one_line(tree_->crs))
      << fmt::format("id OcTree\nsize {}\nres {}\ndata\n", pruned.size(), resolution_m());
  if (pruned.size() > 0) pruned.writeBinaryData(out);
  return std::move(out).str();
}

bool is_occupancy_file(std::string_view bytes) { return is_octree_file(bytes); }

}  // namespace roadbed::map
