#pragma once

#include <string>
#include <vector>

#include "roadbed/geometry/motion/vehicle_shape.h"
#include "roadbed/map/occupancy/clearance/clearance_field.h"
#include "roadbed/planning/lateral/plan_types.h"

namespace roadbed::tools::inline report {

/// One planning cycle as a picture, after the paper's Figs. 8 and 9.
struct PlanPicture {
  const planning::PlanInput& input;
  const planning::Plan& plan;  ///< with its candidates
  const geometry::VehicleShape& vehicle;
  const std::vector<planning::Obstacle>& obstacles;  ///< that are drawn
  std::vector<map::Box2> occupied;                   ///< source coordinates
  std::string title;
};

/// A whole SVG document: the road and its reference line from a little behind the vehicle, every
/// candidate coloured by its verdict, the chosen drive with the vehicle at whole seconds, and
/// obstacles where they are at those times. The vehicle's first heading points to the right; axes
/// in metres from its rear axle.
std::string plan_svg(const PlanPicture& picture);

}  // namespace roadbed::tools::report
