#include "roadbed/map/occupancy/clouds/cloud_formats.h"

#include <algorithm>
#include <cmath>
#include <cstring>

namespace roadbed::map::inline occupancy::inline clouds {
namespace {

constexpr std::size_t kTogether = 2048;

void copy(const FloatRecords& records, std::size_t from, std::size_t count, float* to) {
  const char* record = records.first + from * records.size;
  const bool is_xyz = records.y_offset == records.x_offset + sizeof(float) &&
                      records.z_offset == records.y_offset + sizeof(float);
  if (is_xyz && records.size == 3 * sizeof(float)) {
    std::memcpy(to, record, count * records.size);
    return;
  }
  for (std::size_t i = 0; i < count; ++i, record += records.size, to += 3) {
    if (is_xyz) {
      std::memcpy(to, record + records.x_offset, 3 * sizeof(float));
    } else {
      std::memcpy(to, record + records.x_offset, sizeof(float));
      std::memcpy(to + 1, record + records.y_offset, sizeof(float));
      std::memcpy(to + 2, record + records.z_offset, sizeof(float));
    }
  }
}

bool is_on_earth(float value) {
  return std::abs(value) < static_cast<float>(RawCloud::kBeyondEarth);  // false for NaN
}

bool are_all_on_earth(const float* values, std::size_t count) {
  bool all = true;
  for (std::size_t i = 0; i < count; ++i) all &= is_on_earth(values[i]);
  return all;
}

// Moves the points that may stay to the front, and says how many they are.
std::size_t sift(float* values, std::size_t points) {
  if (are_all_on_earth(values, 3 * points)) return points;
  std::size_t kept = 0;
  for (std::size_t i = 0; i < points; ++i) {
    if (!are_all_on_earth(values + 3 * i, 3)) continue;
    std::copy_n(values + 3 * i, 3, values + 3 * kept++);
  }
  return kept;
}

}  // namespace

void add_float_points(const FloatRecords& records, RawCloud& cloud) {
  if (records.count == 0) return;
  std::vector<Eigen::Vector3f>& points = cloud.float_points_in_source;
  const std::size_t before = points.size();
  points.resize(before + records.count);  // not set to 0: a vector of Eigen's is left as it is
  float* const first = points.data()->data();
  std::size_t kept = before;
  for (std::size_t from = 0; from < records.count; from += kTogether) {
    const std::size_t count = std::min(kTogether, records.count - from);
    copy(records, from, count, first + 3 * kept);
    kept += sift(first + 3 * kept, count);
  }
  cloud.dropped_not_finite += before + records.count - kept;
  points.resize(kept);
}

}  // namespace roadbed::map::occupancy::clouds
