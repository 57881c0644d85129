#include "roadbed/tools/support/vehicle_json.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <vector>

#include "roadbed/map/input_error.h"
#include "roadbed/map/read_file.h"
#include "roadbed/tools/support/json_node.h"

namespace roadbed::tools {
namespace {

using geometry::VehicleShape;
using nlohmann::json;

struct Key {
  std::string_view name;
  double VehicleShape::*value;
};

constexpr std::array<Key, 7> kKeys{{
    {"length_m", &VehicleShape::length_m},
    {"width_m", &VehicleShape::width_m},
    {"rear_overhang_m", &VehicleShape::rear_overhang_m},
    {"wheelbase_m", &VehicleShape::wheelbase_m},
    {"height_m", &VehicleShape::height_m},
    {"max_steering_rad", &VehicleShape::max_steering_rad},
    {"max_steering_rate_radps", &VehicleShape::max_steering_rate_radps},
}};

constexpr double kLongestVehicle_m = 1000.0;

std::string known_keys() {
  std::vector<std::string_view> names;
  for (const Key& key : kKeys) names.push_back(key.name);
  return fmt::format("one of {}", fmt::join(names, ", "));
}

void set(VehicleShape& shape, const std::string& key, const json& value, const std::string& name) {
  const auto refuse = [&](const std::string& found, const std::string& needed) {
    throw map::InputError({.file = name,
                           .place = {},
                           .element = fmt::format("key \"{}\"", key),
                           .found = found,
                           .needed = needed,
                           .remedy = "mend it or leave it out"});
  };
  const auto known =
      std::find_if(kKeys.begin(), kKeys.end(), [&](const Key& k) { return k.name == key; });
  if (known == kKeys.end()) refuse("is not known", known_keys());
  if (!value.is_number()) refuse(fmt::format("is {}", value.type_name()), "a number");
  const double number = value.get<double>();
  if (!(number >= 0.0 && number <= kLongestVehicle_m)) {
    refuse(fmt::format("is {}", number), fmt::format("0 to {}", kLongestVehicle_m));
  }
  shape.*known->value = number;
}

}  // namespace

VehicleShape parse_vehicle_json(std::string_view bytes, const std::string& name) {
  const json document = parse_json_strictly(bytes, name);
  const auto refuse = [&](const std::string& found, const std::string& needed) {
    throw map::InputError({.file = name,
                           .place = {},
                           .element = {},
                           .found = found,
                           .needed = needed,
                           .remedy = "change the vehicle's measures"});
  };
  if (!document.is_object()) refuse(fmt::format("is {}", document.type_name()), "a JSON object");
  VehicleShape shape;
  for (const auto& [key, value] : document.items()) set(shape, key, value, name);
  try {
    shape.check();
  } catch (const std::invalid_argument& error) {
    refuse(error.what(), "");
  }
  return shape;
}

VehicleShape read_vehicle_json(const std::filesystem::path& file) {
  return parse_vehicle_json(map::read_file(file), file.string());
}

}  // namespace roadbed::tools
