#include "roadbed/map/occupancy/clouds/point_time.h"

#include <algorithm>
#include <array>
#include <string_view>

namespace roadbed::map::inline occupancy::inline clouds {

ScalarType scalar_of(const PointField& field) {
  static constexpr std::array types{ScalarType::i8,  ScalarType::u8,  ScalarType::i16,
                                    ScalarType::u16, ScalarType::i32, ScalarType::u32,
                                    ScalarType::f32, ScalarType::f64};
  return types[field.type - 1u];
}

std::optional<PointTime> PointTime::of(const CloudMessage& message) {
  for (const std::string_view name : {"t", "time", "timestamp", "time_stamp"}) {
    const auto field = std::ranges::find(message.fields, name, &PointField::name);
    if (field == message.fields.end()) continue;
    PointTime time;
    time.offset_ = field->offset;
    time.type_ = scalar_of(*field);
    time.is_whole_ = field->type <= 6;
    time.is_big_endian_ = message.is_big_endian;
    time.stamp_ns_ = static_cast<double>(message.stamp_ns);
    return time;
  }
  return std::nullopt;
}

}  // namespace roadbed::map::occupancy::clouds
