#include "roadbed/map/occupancy/cloud_measurements.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <limits>
#include <memory>

#include "roadbed/map/input_error.h"
#include "roadbed/map/occupancy/cell_range.h"

namespace roadbed::map {
namespace {

// What cells may take of memory.
std::size_t most_bytes(std::size_t points) { return 160'000'000 + 64 * points; }

// As OctoMap, in float.
Eigen::Vector3f centre_in_tree(const CellKey& key, double resolution_m) {
  Eigen::Vector3f centre;
  for (int axis = 0; axis < 3; ++axis) {
    const double cells = static_cast<double>(key[static_cast<std::size_t>(axis)]) - kHalfRange;
    centre[axis] = static_cast<float>((cells + 0.5) * resolution_m);
  }
  return centre;
}

// As OctoMap: squares in float, the root in double.
double length_of(const Eigen::Vector3f& way) {
  return std::sqrt(static_cast<double>(way.x() * way.x() + way.y() * way.y() + way.z() * way.z()));
}

template <typename Visit>
void for_each_bit(std::uint64_t word, const Visit& visit) {
  for (; word != 0; word &= word - 1) visit(static_cast<std::size_t>(std::countr_zero(word)));
}

BlockBits bits_where(const std::array<float, 512>& values, bool (*holds)(float, float),
                     float than) {
  BlockBits bits{};
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (holds(values[i], than)) bits[i / 64] |= std::uint64_t{1} << i % 64;
  }
  return bits;
}

}  // namespace

std::optional<CellKey> key_at(const Eigen::Vector3d& in_tree, double resolution_m) {
  const double per_cell = 1.0 / resolution_m;
  CellKey key;
  for (int axis = 0; axis < 3; ++axis) {
    const double cells = in_tree[axis] * per_cell;
    if (!(cells >= -kHalfRange && cells < kHalfRange)) return std::nullopt;
    key[static_cast<std::size_t>(axis)] =
        static_cast<std::uint16_t>(whole_below(cells) + static_cast<std::int64_t>(kHalfRange));
  }
  return key;
}

CloudMeasurements::CloudMeasurements(const Eigen::Vector3d& origin_in_source,
                                     const OccupancyOptions& options, const LogOddsRule& rule,
                                     std::size_t points)
    : origin_in_source_(origin_in_source),
      options_(options),
      rule_(rule),
      most_bytes_(most_bytes(points)),
      carved_(options.resolution_m) {}

void CloudMeasurements::add(const PointCloud& cloud) {
  const std::size_t count = cloud.points.size();
  if (cloud.scans.empty()) add(cloud, {0, count}, cloud.sensor_in_source);
  for (std::size_t i = 0; i < cloud.scans.size(); ++i) {
    const std::size_t next = i + 1 < cloud.scans.size() ? cloud.scans[i + 1].first : count;
    add(cloud, {cloud.scans[i].first, next}, cloud.scans[i].sensor_in_source);
  }
  add_carved(cloud);
}

void CloudMeasurements::add(const PointCloud& cloud, Span points,
                            const std::optional<Eigen::Vector3d>& sensor) {
  blocks_.begin_scan();
  if (sensor) {
    add_scan(cloud, points, *sensor);
  } else {
    add_hits(cloud, points);
  }
  if (options_.sticky_hits) return;
  add_carved(cloud);
  weigh_scan();
}

void CloudMeasurements::add_hits(const PointCloud& cloud, Span points) {
  for (std::size_t i = points.first; i < points.last; ++i) {
    blocks_.mark_hit(checked_key(cloud, "point", cloud.in_source(i)));
    if (i % 256 == 0) check_room(cloud);
  }
  check_room(cloud);
}

void CloudMeasurements::add_scan(const PointCloud& cloud, Span points,
                                 const Eigen::Vector3d& sensor_in_source) {
  const CellKey from = checked_key(cloud, "sensor", sensor_in_source);
  const Eigen::Vector3f sensor = (sensor_in_source - origin_in_source_).cast<float>();
  const double range_m = options_.carve_range_m;
  for (std::size_t i = points.first; i < points.last; ++i) {
    const CellKey key = checked_key(cloud, "point", cloud.in_source(i));
    if (!blocks_.add_end(key)) continue;
    const Eigen::Vector3f end = centre_in_tree(key, options_.resolution_m);
    const double length_m = length_of(end - sensor);
    if (!(length_m > range_m)) {
      blocks_.mark_hit(key);
      carved_.carve(sensor, from, end, key);
    } else {
      if (options_.sticky_hits) blocks_.mark_hit(key);
      const Eigen::Vector3f direction = (end - sensor) / static_cast<float>(length_m);
      const Eigen::Vector3f cut = sensor + direction * static_cast<float>(range_m);
      if (const auto to = key_at(cut.cast<double>(), options_.resolution_m)) {
        carved_.carve(sensor, from, cut, *to);
      }
    }
    check_room(cloud);
  }
}

void CloudMeasurements::add_carved(const PointCloud& cloud) {
  carved_.drain([&](const CellKey& first, const BlockBits& free) {
    blocks_.merge(first, {}, free);
    check_room(cloud);
  });
}

CellKey CloudMeasurements::checked_key(const PointCloud& cloud, const char* what,
                                       const Eigen::Vector3d& in_source) const {
  const auto key = key_at(in_source - origin_in_source_, options_.resolution_m);
  if (key) return *key;
  throw InputError(
      {.file = cloud.name,
       .place = {},
       .element = fmt::format("{} ({}, {}, {})", what, in_source.x(), in_source.y(), in_source.z()),
       .found = fmt::format("lies more than {} cells of {} m from the middle", kHalfRange,
                            options_.resolution_m),
       .needed = {},
       .remedy = "take a coarser resolution, or cut the cloud"});
}

void CloudMeasurements::check_room(const PointCloud& cloud) const {
  const std::size_t log_odds = options_.sticky_hits ? 0 : sizeof(std::array<float, 512>);
  const std::size_t blocks = blocks_.kept_bytes() + blocks_.block_count() * log_odds;
  if (blocks + carved_.kept_bytes() <= most_bytes_) return;
  throw InputError({.file = cloud.name,
                    .place = {},
                    .element = cloud.has_sensor() ? "rays" : "points",
                    .found = "cross more cells than can be kept",
                    .needed = {},
                    .remedy = "take a coarser resolution or a shorter carving range"});
}

// A cell that was hit in a scan was not free in it.
void CloudMeasurements::weigh_scan() {
  for (CellBlock* block : blocks_.touched()) {
    if (!block->log_odds) {
      block->log_odds = std::make_unique<std::array<float, 512>>();
      block->log_odds->fill(std::numeric_limits<float>::quiet_NaN());
    }
    const auto add = [&](std::size_t cell, float change) {
      float& value = (*block->log_odds)[cell];
      value = std::clamp((std::isnan(value) ? 0.0f : value) + change, rule_.least, rule_.most);
    };
    for (std::size_t word = 0; word < block->hit.size(); ++word) {
      const std::uint64_t hit = block->hit[word], free = block->free[word] & ~hit;
      for_each_bit(free, [&](std::size_t bit) { add(64 * word + bit, rule_.miss); });
      for_each_bit(hit, [&](std::size_t bit) { add(64 * word + bit, rule_.hit); });
    }
    block->hit = block->free = {};
  }
}

OctreeBytes CloudMeasurements::bt() {
  if (!options_.sticky_hits) {
    blocks_.for_each([&](CellBlock& block) {
      block.hit = bits_where(
          *block.log_odds, [](float a, float b) { return a >= b; }, rule_.occupied_from);
      block.free = bits_where(
          *block.log_odds, [](float a, float b) { return a < b; }, rule_.occupied_from);
    });
  }
  return bt_data(blocks_);
}

OctreeBytes CloudMeasurements::ot() const { return ot_data(blocks_); }

}  // namespace roadbed::map
