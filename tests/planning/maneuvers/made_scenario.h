#pragma once

#include <fmt/format.h>

#include <string>

#include "roadbed/tools/simulation/scenario.h"

// What scenarios on a made road of the id 1 have in common.
namespace roadbed::tools {

inline constexpr double kCar_m = 4.5;  // length of the others

// A lane is named with its section: "0/-1".
inline ScenarioPlace place(const std::string& lane, double s_m) {
  return {.text = fmt::format("lane:1/{}@{}", lane, s_m), .pointer = "/test"};
}

}  // namespace roadbed::tools
