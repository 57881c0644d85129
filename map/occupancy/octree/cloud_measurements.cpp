#include "roadbed/map/occupancy/octree/cloud_measurements.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <utility>

#include "roadbed/map/files/input_error.h"
#include "roadbed/map/occupancy/octree/cell_range.h"

namespace roadbed::map::inline occupancy::inline octree {
namespace {

// What cells may take of memory.
std::size_t most_bytes(std::size_t points) { return 160'000'000 + 64 * points; }

// Pages of rays that lie far apart are nearly empty: where they take more, they become blocks
// before the scan has ended.
constexpr std::size_t kMostCarvedBytes = 32'000'000;

constexpr std::size_t kAtOnce = 256;  // points whose cells are looked up together

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

// Whether there is a key. Without branches, as points come by the million.
bool find_key(const Eigen::Vector3d& in_tree, double per_cell, CellKey& key) {
  bool is_in_range = true;
  for (int axis = 0; axis < 3; ++axis) {
    const double cells = in_tree[axis] * per_cell;
    const bool is_in = (cells >= -kHalfRange) & (cells < kHalfRange);
    is_in_range &= is_in;
    key[static_cast<std::size_t>(axis)] = static_cast<std::uint16_t>(
        whole_below(is_in ? cells : 0.0) + static_cast<std::int64_t>(kHalfRange));
  }
  return is_in_range;
}

}  // namespace

std::optional<CellKey> key_at(const Eigen::Vector3d& in_tree, double resolution_m) {
  CellKey key;
  return find_key(in_tree, 1.0 / resolution_m, key) ? std::optional(key) : std::nullopt;
}

CloudMeasurements::CloudMeasurements(const Eigen::Vector3d& origin_in_source,
                                     const OccupancyOptions& options, ScanAccumulator sum,
                                     std::size_t points)
    : origin_in_source_(origin_in_source),
      options_(options),
      most_bytes_(most_bytes(points)),
      sum_(std::move(sum)),
      carved_(options.resolution_m) {}

void CloudMeasurements::add(const PointCloud& cloud) {
  const std::size_t count = cloud.points.size();
  blocks_.begin_scan();
  if (cloud.scans.empty()) add(cloud, {0, count}, cloud.sensor_in_source);
  for (std::size_t i = 0; i < cloud.scans.size(); ++i) {
    const std::size_t next = i + 1 < cloud.scans.size() ? cloud.scans[i + 1].first : count;
    add(cloud, {cloud.scans[i].first, next}, cloud.scans[i].sensor_in_source);
  }
  add_carved(cloud);
  if (sum_.takes_clouds()) take_touched();
}

void CloudMeasurements::add(const PointCloud& cloud, Span points,
                            const std::optional<Eigen::Vector3d>& sensor) {
  if (sum_.takes_scans()) {
    blocks_.begin_scan();
  } else {
    blocks_.begin_view();
  }
  if (sensor) {
    add_scan(cloud, points, *sensor);
  } else {
    add_hits(cloud, points);
  }
  if (!sum_.takes_scans()) return;
  add_carved(cloud);
  take_touched();
}

void CloudMeasurements::add_hits(const PointCloud& cloud, Span points) {
  for (Span some{points.first, 0}; some.first < points.last; some.first = some.last) {
    some.last = std::min(some.first + kAtOnce, points.last);
    for (const CellKey& key : keys_of(cloud, some)) blocks_.mark_hit(key);
    check_room(cloud);
  }
}

void CloudMeasurements::add_scan(const PointCloud& cloud, Span points,
                                 const Eigen::Vector3d& sensor_in_source) {
  const CellKey from = checked_key(cloud, "sensor", sensor_in_source);
  const Eigen::Vector3f sensor = (sensor_in_source - origin_in_source_).cast<float>();
  for (Span some{points.first, 0}; some.first < points.last; some.first = some.last) {
    some.last = std::min(some.first + kAtOnce, points.last);
    const std::span<const CellKey> keys = keys_of(cloud, some);
    for (const CellBlocks::End& end : blocks_.add_ends(keys)) {
      add_ray(sensor, from, keys[end.index], end);
      if (carved_.used_bytes() > kMostCarvedBytes) add_carved(cloud);
      check_room(cloud);
    }
  }
}

void CloudMeasurements::add_ray(const Eigen::Vector3f& sensor, const CellKey& from,
                                const CellKey& key, const CellBlocks::End& end) {
  const double range_m = options_.carve_range_m;
  const Eigen::Vector3f centre = centre_in_tree(key, options_.resolution_m);
  const double length_m = length_of(centre - sensor);
  if (!(length_m > range_m)) {
    end.mark_hit();
    carved_.carve(sensor, from, centre, key);
    return;
  }
  if (options_.sticky_hits) end.mark_hit();
  const Eigen::Vector3f direction = (centre - sensor) / static_cast<float>(length_m);
  const Eigen::Vector3f cut = sensor + direction * static_cast<float>(range_m);
  if (const auto to = key_at(cut.cast<double>(), options_.resolution_m)) {
    carved_.carve(sensor, from, cut, *to);
  }
}

void CloudMeasurements::add_carved(const PointCloud& cloud) {
  carved_.drain([&](const CellKey& first, const BlockBits& free) {
    blocks_.merge(first, {}, free);
    check_room(cloud);
  });
}

// Valid until the next call.
std::span<const CellKey> CloudMeasurements::keys_of(const PointCloud& cloud, Span points) {
  keys_.resize(points.last - points.first);
  const double per_cell = 1.0 / options_.resolution_m;
  bool are_in_range = true;
  for (std::size_t i = 0; i < keys_.size(); ++i) {
    are_in_range &=
        find_key(cloud.in_source(points.first + i) - origin_in_source_, per_cell, keys_[i]);
  }
  if (are_in_range) return keys_;
  for (std::size_t i = points.first; i < points.last; ++i) {
    checked_key(cloud, "point", cloud.in_source(i));
  }
  return keys_;
}

CellKey CloudMeasurements::checked_key(const PointCloud& cloud, const char* what,
                                       const Eigen::Vector3d& in_source) const {
  const auto key = key_at(in_source - origin_in_source_, options_.resolution_m);
  if (key) return *key;
  throw InputError(
      {.file = cloud.name,
       .element = fmt::format("{} ({}, {}, {})", what, in_source.x(), in_source.y(), in_source.z()),
       .found = fmt::format("lies more than {} cells of {} m from the middle", kHalfRange,
                            options_.resolution_m),
       .remedy = "take a coarser resolution, or cut the cloud"});
}

void CloudMeasurements::check_room(const PointCloud& cloud) const {
  const std::size_t blocks = blocks_.kept_bytes() + sum_.kept_bytes(blocks_.block_count());
  if (blocks + carved_.kept_bytes() <= most_bytes_) return;
  throw InputError({.file = cloud.name,
                    .element = cloud.has_sensor() ? "rays" : "points",
                    .found = "cross more cells than can be kept",
                    .remedy = "take a coarser resolution or a shorter carving range"});
}

void CloudMeasurements::take_touched() {
  for (CellBlock* block : blocks_.touched()) sum_.take(*block);
}

OctreeBytes CloudMeasurements::bt() {
  sum_.settle(blocks_);
  return bt_data(blocks_);
}

OctreeBytes CloudMeasurements::ot() const { return ot_data(blocks_); }

}  // namespace roadbed::map::occupancy::octree
