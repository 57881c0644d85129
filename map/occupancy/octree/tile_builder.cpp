#include "roadbed/map/occupancy/octree/tile_builder.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <fstream>
#include <stdexcept>

#include "roadbed/map/files/input_error.h"
#include "roadbed/map/occupancy/clouds/cloud_transforms.h"
#include "roadbed/map/occupancy/octree/cell_range.h"
#include "roadbed/map/occupancy/octree/cloud_measurements.h"
#include "roadbed/map/occupancy/octree/tile_file.h"

namespace roadbed::map::inline occupancy::inline octree {
namespace {

constexpr std::int64_t kBlockSide = 8, kMiddleBlock = 4096;  // of the blocks that keys can name

/// A block in a file: its place in blocks from the origin, and what was measured.
struct SpilledBlock {
  std::array<std::int32_t, 3> at;
  std::int32_t unused = 0;
  BlockBits hit, free;
};
static_assert(sizeof(SpilledBlock) == 16 + 2 * sizeof(BlockBits));

// Every third bit of a Morton code, from one on.
std::int64_t axis_of(std::uint64_t code, int axis) {
  std::int64_t value = 0;
  for (int bit = 0; bit < 10; ++bit) {
    value |= static_cast<std::int64_t>(code >> (3 * bit + axis) & 1u) << bit;
  }
  return value;
}

[[noreturn]] void refuse_file(const std::filesystem::path& file, const std::string& found) {
  throw InputError({.file = file.string(), .found = found, .remedy = "check the disk"});
}

[[noreturn]] void refuse_clouds(const std::string& name, const char* what, const char* found) {
  throw InputError({.file = name,
                    .element = fmt::format("{} of all clouds", what),
                    .found = found,
                    .remedy = "take a coarser resolution, or cut the clouds"});
}

template <typename Visit>
void for_each_block(const CellBlocks& blocks, const Visit& visit) {
  for (const CellBlocks::Placed& placed : blocks.regions()) {
    for (std::uint64_t place = 0; place < placed.region->size(); ++place) {
      const CellBlock* block = (*placed.region)[place];
      if (block != nullptr) visit(std::uint64_t{placed.code} << 9 | place, *block);
    }
  }
}

Box3 box_with_sensors(const PointCloud& cloud) {
  Box3 box = bounds(cloud);
  const auto add_sensor = [&](const std::optional<Eigen::Vector3d>& sensor) {
    if (!sensor) return;
    box.min_in_source = box.min_in_source.cwiseMin(*sensor);
    box.max_in_source = box.max_in_source.cwiseMax(*sensor);
  };
  add_sensor(cloud.sensor_in_source);
  for (const ScanStart& scan : cloud.scans) add_sensor(scan.sensor_in_source);
  return box;
}

// Points are floats: far from the cloud's middle they are apart by more than what their cells say.
void check_is_fine(const PointCloud& cloud, double resolution_m) {
  constexpr double most_cells = 0x1p24 / 64.0;  // a 64th of a cell, rounded
  float farthest_m = 0.0f;
  for (const Eigen::Vector3f& point : cloud.points) {
    farthest_m = std::max(farthest_m, point.cwiseAbs().maxCoeff());
  }
  if (farthest_m <= most_cells * resolution_m) return;
  throw InputError(
      {.file = cloud.name,
       .element = "extent",
       .found = fmt::format("reaches {} m from its middle", static_cast<double>(farthest_m)),
       .needed = fmt::format("at most {} m, that points are known to a 64th of a cell",
                             most_cells * resolution_m),
       .remedy = "remove points that are far away by mistake, or cut the cloud"});
}

}  // namespace

std::int64_t tile_side_cells(double side_m, double resolution_m) {
  constexpr double least = 64.0, most = 32768.0;
  const double cells = std::clamp(std::ceil(side_m / resolution_m - 1e-9), least, most);
  return static_cast<std::int64_t>(std::bit_ceil(static_cast<std::uint64_t>(cells)));
}

TileBuilder::TileBuilder(Plan plan) : plan_(std::move(plan)) {
  if (plan_.side_cells < kBlockSide ||
      !std::has_single_bit(static_cast<std::uint64_t>(plan_.side_cells))) {
    throw std::invalid_argument(fmt::format(
        "TileBuilder: a side must be a power of two, 8 or more, got {}", plan_.side_cells));
  }
}

TileBuilder::~TileBuilder() {
  std::error_code ignored;
  for (const auto& [place, blocks] : spilled_blocks_) {
    std::filesystem::remove(spill_file(place), ignored);
  }
}

std::filesystem::path TileBuilder::spill_file(const Place& place) const {
  return plan_.folder / fmt::format("tile_{}_{}.aside", place.second, place.first);
}

// None where the box lies within the range of keys; else a multiple of a quarter of it.
TileBuilder::Shift TileBuilder::shift_of(const Box3& box) const {
  Shift shift{};
  for (int axis = 0; axis < 3; ++axis) {
    const auto [from, to] = cells_along(box, axis);
    if (from > -kHalfRange + 1.0 && to < kHalfRange - 1.0) continue;
    constexpr double step = 0.5 * kHalfRange;
    shift[static_cast<std::size_t>(axis)] =
        static_cast<std::int64_t>(step * std::round(0.5 * (from + to) / step));
  }
  return shift;
}

bool TileBuilder::are_keys_enough(const Box3& box) const {
  const Shift shift = shift_of(box);
  for (int axis = 0; axis < 3; ++axis) {
    const auto [from, to] = cells_along(box, axis);
    const auto moved = static_cast<double>(shift[static_cast<std::size_t>(axis)]);
    if (from - moved < -kHalfRange || to - moved >= kHalfRange) return false;
  }
  return true;
}

std::pair<double, double> TileBuilder::cells_along(const Box3& box, int axis) const {
  const double origin = plan_.origin_in_source[axis];
  return {(box.min_in_source[axis] - origin) / plan_.resolution_m,
          (box.max_in_source[axis] - origin) / plan_.resolution_m};
}

// Pieces of a cloud with rays would count as several clouds.
bool TileBuilder::may_be_cut(const PointCloud& cloud) const {
  return !(keeps_clouds_apart() && cloud.has_sensor());
}

OccupancyOptions TileBuilder::options() const {
  return {.resolution_m = plan_.resolution_m,
          .carve_range_m = plan_.carve_range_m,
          .sticky_hits = plan_.sticky_hits,
          .remove_seen_through = plan_.remove_seen_through};
}

std::optional<SeeThroughRemoval> TileBuilder::seen_through(std::size_t removed) const {
  if (plan_.remove_seen_through == 0) return std::nullopt;
  return SeeThroughRemoval{plan_.remove_seen_through, removed};
}

void TileBuilder::start(const Shift& shift) {
  constexpr std::int64_t farthest = 5'000'000'000;  // what blocks put aside have room for
  if (std::ranges::any_of(shift, [](auto cells) { return std::abs(cells) > farthest; })) {
    refuse_clouds(plan_.name, "extent", "is over 10000000000 cells");
  }
  shift_ = shift;
  const Eigen::Vector3d moved(static_cast<double>(shift[0]), static_cast<double>(shift[1]),
                              static_cast<double>(shift[2]));
  measured_ = std::make_unique<CloudMeasurements>(
      plan_.origin_in_source + plan_.resolution_m * moved, options(), ScanAccumulator(),
      plan_.most_points + plan_.most_bytes / 64);
}

void TileBuilder::add(const PointCloud& cloud) {
  if (!plan_.sticky_hits && !cloud.scans.empty()) {
    throw std::invalid_argument("TileBuilder: log-odds need one sensor position a cloud");
  }
  const Box3 box = box_with_sensors(cloud);
  if (are_keys_enough(box) || !may_be_cut(cloud)) {
    add_piece(cloud, box);
    return;
  }
  check_is_fine(cloud, plan_.resolution_m);
  const double side_m = kHalfRange * plan_.resolution_m;
  for (const PointCloud& piece : split_cloud(cloud, plan_.origin_in_source, side_m)) {
    add_piece(piece, box_with_sensors(piece));
  }
}

void TileBuilder::add_piece(const PointCloud& cloud, const Box3& box) {
  const Shift shift = shift_of(box);
  if (measured_ && shift != shift_) spill();
  if (!measured_) start(shift);
  measured_->add(cloud);
  if (keeps_clouds_apart() || measured_->blocks().kept_bytes() > plan_.most_bytes) spill();
}

void TileBuilder::spill() {
  std::map<Place, std::string> bytes;
  for_each_block(measured_->blocks(), [&](std::uint64_t code, const CellBlock& block) {
    if (block.hit == BlockBits{} && block.free == BlockBits{}) return;
    SpilledBlock aside{.at = {}, .hit = block.hit, .free = block.free};
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const std::int64_t region = axis_of(code >> 9, static_cast<int>(axis));
      const std::int64_t place = axis_of(code & 511u, static_cast<int>(axis));
      aside.at[axis] =
          static_cast<std::int32_t>(8 * region + place - kMiddleBlock + shift_[axis] / kBlockSide);
    }
    const std::int64_t blocks_a_side = plan_.side_cells / kBlockSide;
    const Place tile{floor_div(aside.at[1], blocks_a_side), floor_div(aside.at[0], blocks_a_side)};
    bytes[tile].append(reinterpret_cast<const char*>(&aside), sizeof aside);
  });
  measured_.reset();
  for (const auto& [tile, data] : bytes) {
    // What another run left under that name is not ours.
    std::size_t& blocks = spilled_blocks_[tile];
    std::ofstream file(spill_file(tile),
                       std::ios::binary | (blocks == 0 ? std::ios::trunc : std::ios::app));
    blocks += data.size() / sizeof(SpilledBlock);
    file.write(data.data(), static_cast<std::streamsize>(data.size()));
    if (!file.flush()) refuse_file(spill_file(tile), "cannot be written");
  }
}

void TileBuilder::make_tile(const Place& place, TilesIndex& index, const Write& write) {
  CellBlocks blocks;
  ScanAccumulator sum(options());
  std::ifstream file(spill_file(place), std::ios::binary);
  std::error_code error;
  if (std::filesystem::file_size(spill_file(place), error) !=
      spilled_blocks_.at(place) * sizeof(SpilledBlock)) {
    refuse_file(spill_file(place), "was changed by another program");
  }
  const std::int64_t first_x = place.second * plan_.side_cells,
                     first_y = place.first * plan_.side_cells;
  for (std::size_t i = 0; i < spilled_blocks_.at(place); ++i) {
    SpilledBlock aside;
    if (!file.read(reinterpret_cast<char*>(&aside), sizeof aside)) {
      refuse_file(spill_file(place), "cannot be read");
    }
    const auto middle = static_cast<std::int64_t>(kHalfRange);
    const std::array<std::int64_t, 3> key{kBlockSide * aside.at[0] - first_x + middle,
                                          kBlockSide * aside.at[1] - first_y + middle,
                                          kBlockSide * aside.at[2] + middle};
    if (key[2] < 0 || key[2] >= 2 * middle)
      refuse_clouds(plan_.name, "height", "is over 65536 cells");
    CellBlock& block =
        blocks.merge({static_cast<std::uint16_t>(key[0]), static_cast<std::uint16_t>(key[1]),
                      static_cast<std::uint16_t>(key[2])},
                     aside.hit, aside.free);
    if (keeps_clouds_apart()) sum.take(block);
  }
  sum.settle(blocks);
  removed_ += sum.removed();
  add_tile(index, place.second, place.first, bt_data(blocks), seen_through(sum.removed()), write);
}

TilesIndex TileBuilder::finish(const Write& write) {
  if (measured_) spill();
  TilesIndex index{.resolution_m = plan_.resolution_m,
                   .origin_in_source = plan_.origin_in_source,
                   .crs = plan_.crs,
                   .side_cells = plan_.side_cells,
                   .tiles = {}};
  for (const auto& [place, blocks] : spilled_blocks_) make_tile(place, index, write);
  index.seen_through = seen_through(removed_);
  return index;
}

}  // namespace roadbed::map::occupancy::octree
