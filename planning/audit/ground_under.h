#pragma once

#include <memory>

#include "roadbed/geometry/motion/trajectory.h"
#include "roadbed/map/model/road_map.h"
#include "roadbed/map/occupancy/clearance/clearance_field.h"
#include "roadbed/map/occupancy/ground/drive_ground.h"
#include "roadbed/map/occupancy/ground/ground.h"
#include "roadbed/map/occupancy/octree/occupancy_source.h"

namespace roadbed::planning::inline audit {

/// What the heights of a vehicle are to be above: a level, the lanes of a map, or what was
/// measured.
struct GroundRule {
  /// A level, the lanes of a map, or the lowest that was measured.
  enum class Kind { level, map, measured };
  Kind kind = Kind::level;
  double level_m = 0.0;
  const map::RoadMap* road_map = nullptr;  ///< of Kind::map
};

/// What heights of a vehicle are above: a level, or a ground that follows the drive.
struct GroundUnder {
  double level_m = 0.0;
  std::shared_ptr<const map::Ground> surface = nullptr;
  double margin_m = 0.0;  ///< the ground may be this much lower or higher

  /// Holds the heights above the ground wherever within the margin that is.
  map::HeightBand band(double from_height_m, double to_height_m) const {
    const double from_m = from_height_m - margin_m, to_m = to_height_m + margin_m;
    if (surface) return {from_m, to_m, surface.get()};
    return {level_m + from_m, level_m + to_m};
  }
};

/// The ground under a drive by a rule.
/// @param body  what needs ground under it, where that is measured.
/// @throws InputError if it cannot be told, or lies apart from all that was measured.
GroundUnder ground_under(const map::OccupancySource& occupancy,
                         const geometry::Trajectory& drive_in_source, const GroundRule& rule,
                         const map::BodyReach& body);

}  // namespace roadbed::planning::audit
