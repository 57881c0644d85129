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

namespace {

bool is_whole(const PointField& field) { return field.type <= 6; }

bool has_known_unit(const PointField& field) {
  if (field.name == "offset_time") return is_whole(field);
  return field.name != "timeOffset" || !is_whole(field);
}

}  // namespace

std::optional<PointTime> PointTime::of(const CloudMessage& message) {
  for (const std::string_view name :
       {"t", "time", "timestamp", "time_stamp", "offset_time", "timeOffset"}) {
    const auto field = std::ranges::find(message.fields, name, &PointField::name);
    if (field == message.fields.end() || !has_known_unit(*field)) continue;
    PointTime time;
    time.offset_ = field->offset;
    time.type_ = scalar_of(*field);
    time.is_whole_ = is_whole(*field);
    time.is_big_endian_ = message.is_big_endian;
    time.stamp_ns_ = static_cast<double>(message.stamp_ns);
    return time;
  }
  return std::nullopt;
}

std::string PointTime::untaken_field(const CloudMessage& message) {
  if (of(message)) return {};
  const auto may_be_time = [](const PointField& field) {
    const std::string name = lower(field.name);
    return name == "t" || name == "curvature" || name.find("time") != std::string::npos ||
           name.find("stamp") != std::string::npos;
  };
  const auto field = std::ranges::find_if(message.fields, may_be_time);
  return field == message.fields.end() ? std::string() : field->name;
}

}  // namespace roadbed::map::occupancy::clouds
