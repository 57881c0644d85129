#pragma once

#include <string>
#include <string_view>

#include "roadbed/geometry/motion/rectangle.h"
#include "roadbed/geometry/motion/vehicle_shape.h"
#include "roadbed/map/model/road_map.h"
#include "roadbed/planning/lateral/planned_path.h"

namespace roadbed::tools::inline simulation {

/// How the vehicle and another one touched, as nuPlan tells them apart.
enum class CollisionKind {
  stopped_vehicle,  ///< the vehicle stood
  stopped_other,
  rear,     ///< the other's middle is behind, within 30° of the vehicle's axis
  front,    ///< with the front bumper
  lateral,  ///< all others
};
std::string_view to_string(CollisionKind kind);

struct Collision {
  std::string with;  ///< the other's id
  CollisionKind kind = CollisionKind::front;
  /// The vehicle's own doing: who drove into somebody with its front or into who stood, or was hit
  /// at its side while it was not wholly in one lane.
  bool is_at_fault = false;
};

/// Another one that is touched, and its speed.
struct TouchedBody {
  std::string id;
  geometry::Rectangle body;
  double speed_mps = 0.0;
};

/// nuPlan's rule of who caused a collision (no_ego_at_fault_collisions): standing is below 0.05
/// m/s.
Collision judge_collision(const map::RoadMap& road_map, const planning::VehicleState& vehicle,
                          const geometry::VehicleShape& shape, const TouchedBody& other);

}  // namespace roadbed::tools::simulation
