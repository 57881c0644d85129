#include "roadbed/map/occupancy/octree/tiled_occupancy.h"

#include <algorithm>
#include <utility>

#include "roadbed/map/files/input_error.h"
#include "roadbed/map/files/read_file.h"
#include "roadbed/map/files/sha256.h"

namespace roadbed::map::inline occupancy::inline octree {
namespace {

bool do_meet(const Box3& a, const Box3& b) {
  return (a.min_in_source.array() <= b.max_in_source.array()).all() &&
         (b.min_in_source.array() <= a.max_in_source.array()).all();
}

// The square of a tile, at any height: the index's bounds are not asked what is to be read.
Box3 square_of(const TilesIndex& index, const OccupancyTile& tile) {
  constexpr double any_height_m = 1e7;
  const Eigen::Vector3d& origin = index.origin_in_source;
  const Eigen::Vector3d least(origin.x() + index.side_m() * static_cast<double>(tile.x),
                              origin.y() + index.side_m() * static_cast<double>(tile.y),
                              -any_height_m);
  return {least, {least.x() + index.side_m(), least.y() + index.side_m(), any_height_m}};
}

bool is_that_of(const OccupancyMap& map, const TilesIndex& index, const OccupancyTile& tile) {
  constexpr double rounding_m = 1e-4;
  const Box3 square = square_of(index, tile);
  const Eigen::Vector3d origin(square.min_in_source.x(), square.min_in_source.y(),
                               index.origin_in_source.z());
  const std::optional<Box3> box = map.bounds();
  return map.resolution_m() == index.resolution_m &&
         (map.origin_in_source() - origin).norm() < rounding_m && box &&
         (box->min_in_source - tile.bounds.min_in_source).norm() < rounding_m &&
         (box->max_in_source - tile.bounds.max_in_source).norm() < rounding_m &&
         (box->min_in_source.array() > square.min_in_source.array() - rounding_m).all() &&
         (box->max_in_source.array() < square.max_in_source.array() + rounding_m).all();
}

}  // namespace

TiledOccupancy::TiledOccupancy(const std::filesystem::path& folder)
    : folder_(folder),
      index_(parse_tiles_index(read_file(tiles_index_file(folder)),
                               tiles_index_file(folder).string())) {}

std::optional<Box3> TiledOccupancy::bounds() const {
  if (index_.tiles.empty()) return std::nullopt;
  Box3 box = index_.tiles.front().bounds;
  for (const OccupancyTile& tile : index_.tiles) {
    box.min_in_source = box.min_in_source.cwiseMin(tile.bounds.min_in_source);
    box.max_in_source = box.max_in_source.cwiseMax(tile.bounds.max_in_source);
  }
  return box;
}

void TiledOccupancy::for_each_cell(const UseCell& use) const {
  for (const OccupancyTile& tile : index_.tiles) load(tile)->for_each_cell(use);
}

void TiledOccupancy::for_each_in(const Box3& box, const UseCell& use) const {
  for (const OccupancyTile& tile : index_.tiles) {
    if (do_meet(square_of(index_, tile), box)) load(tile)->for_each_in(box, use);
  }
}

std::vector<OccupancyCell> TiledOccupancy::cells_of_tiles(std::span<const Box3> boxes) const {
  std::vector<OccupancyCell> cells;
  for (const OccupancyTile& tile : index_.tiles) {
    const Box3 square = square_of(index_, tile);
    const auto meets = [&](const Box3& box) { return do_meet(square, box); };
    if (std::ranges::none_of(boxes, meets)) continue;
    load(tile)->for_each_cell([&](const OccupancyCell& cell) { cells.push_back(cell); });
  }
  return cells;
}

std::size_t TiledOccupancy::tiles_read() const {
  const std::lock_guard lock(mutex_);
  return tiles_read_;
}

std::shared_ptr<const OccupancyMap> TiledOccupancy::load(const OccupancyTile& tile) const {
  const std::lock_guard lock(mutex_);
  const auto found = std::ranges::find(alive_, &tile, &Alive::tile);
  if (found != alive_.end()) {
    alive_.splice(alive_.begin(), alive_, found);
    return alive_.front().map;
  }
  const std::filesystem::path file = folder_ / tile.file;
  const std::string bytes = read_file(file, most_unpacked_of_rows);
  if (const std::string hash = sha256_of_bytes(bytes); hash != tile.sha256) {
    throw InputError({.file = file.string(),
                      .found = "has the SHA-256 " + hash,
                      .needed = tile.sha256 + " as the index says",
                      .remedy = "build the tiles again"});
  }
  auto map = std::make_shared<const OccupancyMap>(OccupancyMap::parse(bytes, file.string()));
  if (!is_that_of(*map, index_, tile)) {
    throw InputError({.file = file.string(),
                      .found = "has another resolution, origin or bounds",
                      .needed = "those of the index",
                      .remedy = "build the tiles again"});
  }
  if (alive_.size() >= kMostAlive) alive_.pop_back();
  alive_.push_front({&tile, std::move(map)});
  ++tiles_read_;
  return alive_.front().map;
}

std::unique_ptr<OccupancySource> open_occupancy(const std::filesystem::path& path) {
  if (is_tiled_occupancy(path)) return std::make_unique<TiledOccupancy>(path);
  return std::make_unique<OccupancyMap>(OccupancyMap::load(path));
}

}  // namespace roadbed::map::occupancy::octree
