#pragma once

#include <array>
#include <string>

#include "roadbed/map/files/input_error.h"
#include "roadbed/map/occupancy/clouds/read_point_cloud.h"

namespace roadbed::tests {

/// A cloud in; itself or InputError out. Its size says what it is filtered by.
inline void read_cloud(const std::string& bytes, const std::string& name) {
  static const std::array<map::CloudFilter, 4> filters{
      map::CloudFilter{},
      map::CloudFilter{.classes = {2, 5}, .left_out_classes = {5}, .intensity = {{0.1, 200.0}}},
      map::CloudFilter{.returns = {1, 2}, .last_returns = true},
      map::CloudFilter{.intensity = {{0.1, 200.0}}, .vehicle_box = {{{-1, -1, 0}, {1, 1, 2}}}}};
  try {
    map::parse_point_cloud(bytes, name, filters[bytes.size() % filters.size()]);
  } catch (const map::InputError&) {
    return;  // refused, as it should be
  }
}

}  // namespace roadbed::tests
