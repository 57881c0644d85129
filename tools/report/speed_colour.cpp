#include "roadbed/tools/report/speed_colour.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace roadbed::tools::inline report {
namespace {

using Colour = std::array<double, 3>;
constexpr std::array<Colour, 6> kStops = {
    {{68, 1, 84}, {65, 68, 135}, {42, 120, 142}, {34, 168, 132}, {122, 209, 81}, {253, 231, 37}}};

}  // namespace

std::string speed_colour(double share) {
  const double place = std::clamp(share, 0.0, 1.0) * (kStops.size() - 1);
  const std::size_t below = std::min(static_cast<std::size_t>(place), kStops.size() - 2);
  const double part = place - static_cast<double>(below);
  Colour mixed{};
  for (std::size_t i = 0; i < mixed.size(); ++i) {
    mixed[i] = std::round((1.0 - part) * kStops[below][i] + part * kStops[below + 1][i]);
  }
  return fmt::format("#{:02x}{:02x}{:02x}", static_cast<int>(mixed[0]), static_cast<int>(mixed[1]),
                     static_cast<int>(mixed[2]));
}

}  // namespace roadbed::tools
