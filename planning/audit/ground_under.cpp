#include "roadbed/planning/audit/ground_under.h"

#include <fmt/format.h>

#include <optional>
#include <utility>

#include "roadbed/map/files/input_error.h"
#include "roadbed/map/occupancy/ground/drive_ground.h"

namespace roadbed::planning::inline audit {
namespace {

// A map and a cloud whose heights are apart cannot be meant for each other.
void check_heights(const map::OccupancySource& occupancy, const map::Ground& ground) {
  constexpr double near_m = 5.0;
  const std::optional<map::Box3> bounds = occupancy.bounds();
  if (!bounds) return;
  const double least_m = bounds->min_in_source.z(), most_m = bounds->max_in_source.z();
  if (ground.highest_m() > least_m - near_m && ground.lowest_m() < most_m + near_m) return;
  throw map::InputError(
      {.file = "ground",
       .found = fmt::format("the map's roads lie at z {:.1f} m to {:.1f} m", ground.lowest_m(),
                            ground.highest_m()),
       .needed = fmt::format("the occupancy's {:.1f} m to {:.1f} m", least_m, most_m),
       .remedy = "bring both into one frame, or give --ground Z"});
}

}  // namespace

GroundUnder ground_under(const map::OccupancySource& occupancy,
                         const geometry::Trajectory& drive_in_source, const GroundRule& rule,
                         const map::BodyReach& body) {
  if (rule.kind == GroundRule::Kind::level) return {.level_m = rule.level_m};
  const bool is_map = rule.kind == GroundRule::Kind::map;
  auto ground = std::make_shared<const map::Ground>(
      is_map ? map::road_under(*rule.road_map, drive_in_source)
             : map::measured_under(occupancy, drive_in_source, body));
  if (is_map) check_heights(occupancy, *ground);
  GroundUnder under{.level_m = ground->lowest_m()};
  if (!is_map) under.margin_m = map::measured_ground_margin_m(occupancy.resolution_m());
  if (!ground->is_level()) under.surface = std::move(ground);
  return under;
}

}  // namespace roadbed::planning::audit
