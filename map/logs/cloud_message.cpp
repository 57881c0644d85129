#include "roadbed/map/logs/cloud_message.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "roadbed/map/logs/cdr.h"
#include "roadbed/map/logs/pose_messages.h"

namespace roadbed::map::inline logs {
namespace {

constexpr std::array<std::uint8_t, 9> kBytesOfType{0, 1, 1, 2, 2, 4, 4, 4, 8};

// A field may be an array, of which the first value is taken; 0 values mean 1, as PCL reads it.
struct Field {
  PointField first;
  std::uint64_t count;
};

Field read_field(Cdr& cdr) {
  PointField field{.name = cdr.text(),
                   .offset = cdr.number<std::uint32_t>(),
                   .type = cdr.number<std::uint8_t>()};
  const auto count = cdr.number<std::uint32_t>();
  if (field.type == 0 || field.type >= kBytesOfType.size()) {
    cdr.refuse(fmt::format("has a field {} of type {}", field.name, field.type), "types 1 to 8");
  }
  return {std::move(field), std::max<std::uint64_t>(count, 1)};
}

void check_fits(const Cdr& cdr, const Field& field, std::size_t point_step) {
  const std::uint64_t end = field.first.offset + kBytesOfType[field.first.type] * field.count;
  if (end > point_step) {
    cdr.refuse(fmt::format("has a field {} that ends at byte {}", field.first.name, end),
               fmt::format("an end within the {} bytes of a point", point_step));
  }
}

// Each number has 32 bits, so that products fit.
void check_rows(const Cdr& cdr, const CloudMessage& cloud) {
  if (cloud.height == 0 || cloud.width == 0) return;
  const std::uint64_t row = std::uint64_t{cloud.width} * cloud.point_step;
  if (cloud.height > 1 && row > cloud.row_step) {
    cdr.refuse(fmt::format("has rows of {} points of {} bytes in {}", cloud.width, cloud.point_step,
                           cloud.row_step),
               fmt::format("{} bytes", row));
  }
  const std::uint64_t before_last = std::uint64_t{cloud.height - 1} * cloud.row_step;
  if (before_last > cloud.data.size() || row > cloud.data.size() - before_last) {
    cdr.refuse(fmt::format("has {} rows of {} points in {} bytes", cloud.height, cloud.width,
                           cloud.data.size()),
               fmt::format("{} and {} bytes", before_last, row));
  }
}

}  // namespace

bool is_cloud_type(std::string_view type) { return type == "sensor_msgs/msg/PointCloud2"; }

CloudMessage parse_cloud(const LogTopic& topic, const LogMessage& message,
                         const std::string& file) {
  constexpr std::size_t least_bytes_of_field = 13;
  Cdr cdr(message.bytes, file, topic.name + ", " + message.place);
  MessageHeader header = read_header(cdr, message.received_ns);
  CloudMessage cloud{.stamp_ns = header.stamp_ns,
                     .frame = std::move(header.frame),
                     .height = cdr.number<std::uint32_t>(),
                     .width = cdr.number<std::uint32_t>(),
                     .fields = {},
                     .is_big_endian = false,
                     .point_step = 0,
                     .row_step = 0,
                     .data = {}};
  std::vector<Field> fields(cdr.count(least_bytes_of_field));
  for (Field& field : fields) field = read_field(cdr);
  cloud.is_big_endian = cdr.number<std::uint8_t>() != 0;
  cloud.point_step = cdr.number<std::uint32_t>();
  cloud.row_step = cdr.number<std::uint32_t>();
  cloud.data = cdr.take(cdr.count(1));
  for (Field& field : fields) {
    check_fits(cdr, field, cloud.point_step);
    cloud.fields.push_back(std::move(field.first));
  }
  check_rows(cdr, cloud);
  return cloud;
}

}  // namespace roadbed::map::logs
