#include "roadbed/map/occupancy/octree/occupancy_merge.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <set>
#include <stdexcept>
#include <utility>

#include "roadbed/map/files/input_error.h"
#include "roadbed/map/occupancy/octree/cell_key.h"
#include "roadbed/map/occupancy/octree/cell_range.h"
#include "roadbed/map/occupancy/octree/merged_tree.h"
#include "roadbed/map/occupancy/octree/octree_bytes.h"
#include "roadbed/map/occupancy/octree/tile_file.h"
#include "roadbed/map/occupancy/octree/tiled_occupancy.h"

namespace roadbed::map::inline occupancy::inline octree {
namespace {

constexpr auto kHalf = static_cast<std::int64_t>(kHalfRange);

const OccupancySource& first_of(const std::vector<NamedOccupancy>& sources) {
  if (sources.empty()) throw std::invalid_argument("OccupancyMerge: there is no source");
  return *sources.front().occupancy;
}

std::vector<Box3> measured_boxes(const OccupancySource& occupancy) {
  std::vector<Box3> boxes;
  if (const auto* tiled = dynamic_cast<const TiledOccupancy*>(&occupancy)) {
    for (const OccupancyTile& tile : tiled->index().tiles) boxes.push_back(tile.bounds);
  } else if (const std::optional<Box3> box = occupancy.bounds()) {
    boxes.push_back(*box);
  }
  return boxes;
}

// Of several: the fewest clouds that took a hit away, and all hits that went.
std::optional<SeeThroughRemoval> all_seen_through(const std::vector<NamedOccupancy>& sources) {
  std::optional<SeeThroughRemoval> all;
  for (const NamedOccupancy& source : sources) {
    const auto removed = source.occupancy->seen_through();
    if (!removed) continue;
    all =
        all ? SeeThroughRemoval{std::min(all->clouds, removed->clouds), all->cells + removed->cells}
            : *removed;
  }
  return all;
}

// Where an axis may be counted from: 0 if that does, else near the middle, at a multiple of a power
// of two as large as does, so that most nodes of the sources stay nodes. None if it is too long.
std::optional<std::int64_t> origin_of_axis(std::int64_t from, std::int64_t to) {
  const auto holds = [&](std::int64_t origin) {
    return from >= origin - kHalf && to <= origin + kHalf;
  };
  if (holds(0)) return 0;
  for (std::int64_t step = kHalf / 2; step > 0; step /= 2) {
    const std::int64_t origin = step * floor_div(from + to + step, 2 * step);
    if (holds(origin)) return origin;
  }
  return std::nullopt;
}

[[noreturn]] void refuse_extent(const std::string& name, std::string found, std::string remedy) {
  throw InputError({.file = name,
                    .element = "extent",
                    .found = std::move(found),
                    .needed = fmt::format("at most {} in one octree", 2 * kHalf),
                    .remedy = std::move(remedy)});
}

}  // namespace

/// Where an octree's cells are counted from, of the grid.
struct OccupancyMerge::Frame {
  CellPlace origin;
  CellPlace corner() const { return {origin[0] - kHalf, origin[1] - kHalf, origin[2] - kHalf}; }
};

OccupancyMerge::OccupancyMerge(std::vector<NamedOccupancy> sources, MergeOptions options)
    : sources_(std::move(sources)),
      options_(std::move(options)),
      grid_(first_of(sources_)),
      seen_through_(all_seen_through(sources_)) {
  const CellBox part = grid_.cells_with_middle_in(options_.part.box);
  for (const NamedOccupancy& source : sources_) {
    check_one_grid(*sources_.front().occupancy, sources_.front().name, *source.occupancy,
                   source.name);
    for (const Box3& box : measured_boxes(*source.occupancy)) {
      const CellBox cells = grid_.cells_of(box).cut(part);
      if (cells.empty()) continue;
      measured_.push_back(cells);
      cells_ = cells_.joined(cells);
    }
  }
}

OccupancyMerge::Frame OccupancyMerge::frame_of_one_octree() const {
  Frame frame{};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const std::int64_t from = cells_.from[axis], to = cells_.to[axis];
    const std::optional<std::int64_t> origin = origin_of_axis(from, to);
    if (!origin) {
      refuse_extent(sources_.front().name, fmt::format("{} cells along one axis", to - from),
                    "write tiles (.tiles), or take a smaller part");
    }
    frame.origin[axis] = *origin;
  }
  return frame;
}

OccupancyMap::File OccupancyMerge::file(bool as_log_odds) const {
  const Frame frame = frame_of_one_octree();
  const MergedTree tree(sources_, options_, grid_, cells_, frame.corner());
  OctreeBytes data = as_log_odds ? tree.ot() : tree.bt();
  const OctreeHeader header{.resolution_m = first_of(sources_).resolution_m(),
                            .nodes = data.nodes,
                            .origin_in_source = grid_.corner_in_source(frame.origin),
                            .crs = first_of(sources_).crs(),
                            .seen_through = seen_through_};
  data.data.insert(0, octree_header(as_log_odds ? OctreeForm::ot : OctreeForm::bt, header));
  return {std::move(data.data), data.nodes, seen_through_};
}

OccupancyMap::File OccupancyMerge::bt() const { return file(false); }
OccupancyMap::File OccupancyMerge::ot() const { return file(true); }

TilesIndex OccupancyMerge::tiles(std::int64_t side_cells, const Write& write) const {
  if (cells_.from[2] < -kHalf || cells_.to[2] > kHalf) {
    refuse_extent(
        sources_.front().name,
        fmt::format("heights of {} to {} cells from the origin", cells_.from[2], cells_.to[2]),
        "take a part with --heights");
  }
  std::set<std::pair<std::int64_t, std::int64_t>> places;  // y and x, as the index has them
  for (const CellBox& box : measured_) {
    for (std::int64_t y = floor_div(box.from[1], side_cells); y * side_cells < box.to[1]; ++y) {
      for (std::int64_t x = floor_div(box.from[0], side_cells); x * side_cells < box.to[0]; ++x) {
        places.emplace(y, x);
      }
    }
  }
  TilesIndex index{.resolution_m = first_of(sources_).resolution_m(),
                   .origin_in_source = grid_.corner_in_source({0, 0, 0}),
                   .crs = first_of(sources_).crs(),
                   .side_cells = side_cells,
                   .tiles = {},
                   .seen_through = seen_through_};
  for (const auto& [y, x] : places) {
    const Frame frame{{x * side_cells, y * side_cells, 0}};
    const CellBox square{{x * side_cells, y * side_cells, -kHalf},
                         {(x + 1) * side_cells, (y + 1) * side_cells, kHalf}};
    const OctreeBytes data =
        MergedTree(sources_, options_, grid_, square.cut(cells_), frame.corner()).bt();
    if (data.nodes > 0) add_tile(index, x, y, data, seen_through_, write);
  }
  return index;
}

}  // namespace roadbed::map::occupancy::octree
