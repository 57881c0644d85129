#include "roadbed/map/lanelet2/autoware/right_of_way.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "roadbed/map/lanelet2/autoware/shapes.h"

namespace roadbed::map::lanelet2::autoware {
namespace {

/// Below this share of a lanelet, another one that overlaps it may or may not have to yield.
constexpr double kSlight = 0.01;

/// The direction that a lanelet's first traffic light faces; none if it has no light.
std::optional<Eigen::Vector2d> light_direction(const VectorMap& map, const Lanelet& lanelet) {
  const auto elements = regulations_of(lanelet, "traffic_light");
  if (elements.empty()) return {};
  const auto lights = map.lines(*elements.front(), "refers");
  if (lights.empty() || lights.front()->nodes.size() < 2) return {};
  const Line2 line = plan_of(map, *lights.front());
  const Eigen::Vector2d along = line.back() - line.front();
  constexpr double kLeast_m = 1e-6;
  if (along.norm() < kLeast_m) return {};
  return along.normalized();
}

/// Whether two lanelets are green at different times: their lights face across each other, or one
/// has none.
bool are_green_apart(const VectorMap& map, const Lanelet& one, const Lanelet& other) {
  const auto a = light_direction(map, one), b = light_direction(map, other);
  return !a || !b || std::abs(a->dot(*b)) <= std::sqrt(0.5);
}

/// Whether the turn of a lanelet is the near one, and that of another the one across the road, from
/// the opposite side: they are green together, and the longer way round has to yield.
bool goes_before(const Lanelet& lanelet, const Lanelet& other) {
  const std::string_view one = lanelet.tag("turn_direction"), two = other.tag("turn_direction");
  const bool opposite = (one == "left" && two == "right") || (one == "right" && two == "left");
  return opposite && way_length_m(*lanelet.surface) < way_length_m(*other.surface);
}

}  // namespace

bool have_one_source(const VectorMap& map, const Lanelet& one, const Lanelet& other) {
  const auto before = map.previous(other);
  return std::ranges::any_of(map.previous(one), [&](const Lanelet* lanelet) {
    return std::ranges::count(before, lanelet) > 0;
  });
}

Conflicts conflicts_of(const VectorMap& map, const Lanelet& lanelet, const MustYield& must_yield) {
  Conflicts found;
  for (const auto& [other, share] : conflicts(map, lanelet)) {
    if (!must_yield(lanelet, *other)) continue;
    if (share < kSlight) {
      found.slightly.emplace(other->id(), share);
    } else {
      found.yielding.insert(other->id());
    }
  }
  return found;
}

bool turns_at_lights(const Lanelet& lanelet) {
  const std::string_view direction = lanelet.tag("turn_direction");
  return (direction == "left" || direction == "right") &&
         !regulations_of(lanelet, "traffic_light").empty();
}

bool yields_at_lights(const VectorMap& map, const Lanelet& lanelet, const Lanelet& other) {
  return !have_one_source(map, lanelet, other) &&
         (are_green_apart(map, lanelet, other) || goes_before(lanelet, other));
}

}  // namespace roadbed::map::lanelet2::autoware
