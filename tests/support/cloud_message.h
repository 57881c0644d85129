#pragma once

#include <bit>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "roadbed/tests/support/log_bytes.h"

namespace roadbed::tests {

/// A PointCloud2 message, whose claims may be wrong.
struct MadeCloud {
  struct Field {
    std::string name;
    std::uint32_t offset;
    std::uint8_t type;  ///< 6: uint32, 7: float32, 8: float64
  };

  std::int64_t stamp_ns = 0;
  std::string frame = "lidar";
  std::uint32_t height = 1, width = 0;
  std::vector<Field> fields = {{"x", 0, 7}, {"y", 4, 7}, {"z", 8, 7}};
  bool is_big_endian = false;
  std::uint32_t point_step = 12, row_step = 0;
  std::string data = {};

  /// Appends a number, of the byte order of the points.
  template <class Number>
  MadeCloud& put(Number value) {
    std::string bytes(reinterpret_cast<const char*>(&value), sizeof value);
    if (is_big_endian != (std::endian::native == std::endian::big)) {
      bytes.assign(bytes.rbegin(), bytes.rend());
    }
    data += bytes;
    return *this;
  }
  MadeCloud& pad(std::size_t bytes) {
    data.append(bytes, '\xee');
    return *this;
  }

  std::string message(bool is_big_message = false) const {
    CdrWriter cdr(is_big_message);
    cdr.put(static_cast<std::int32_t>(stamp_ns / 1'000'000'000));
    cdr.put(static_cast<std::uint32_t>(stamp_ns % 1'000'000'000)).text(frame);
    cdr.put(height).put(width).put(static_cast<std::uint32_t>(fields.size()));
    for (const Field& field : fields) {
      cdr.text(field.name).put(field.offset).put(field.type).put(std::uint32_t{1});
    }
    cdr.put(static_cast<std::uint8_t>(is_big_endian)).put(point_step).put(row_step);
    cdr.put(static_cast<std::uint32_t>(data.size()));
    for (const char byte : data) cdr.put(byte);
    return cdr.put(std::uint8_t{0}).bytes();
  }
};

}  // namespace roadbed::tests
