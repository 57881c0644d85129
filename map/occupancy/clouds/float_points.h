#pragma once

// Private to map/occupancy.

#include <cstddef>

#include "roadbed/map/occupancy/clouds/cloud_formats.h"

namespace roadbed::map::inline occupancy::inline clouds {

/// Records of one size that hold x, y and z as floats in the order of this machine's bytes.
struct FloatRecords {
  const char* first;
  std::size_t count, size;                   ///< records, and bytes of each
  std::size_t x_offset, y_offset, z_offset;  ///< bytes before them in a record
};

/// Takes the points of records into a cloud, as `RawCloud::add` does one by one, but some thousands
/// at a time: copied, then judged all together.
void add_float_points(const FloatRecords& records, RawCloud& cloud);

}  // namespace roadbed::map::occupancy::clouds
