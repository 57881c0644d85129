#pragma once

#include <optional>

#include "roadbed/geometry/motion/vehicle_shape.h"
#include "roadbed/tools/simulation/drive.h"
#include "roadbed/tools/simulation/world.h"

namespace roadbed::tools::inline simulation {

/// A least time [s], and when.
struct Encounter {
  double time_s = 0.0;
  double at_s = 0.0;
};

/// Least time to collision of a drive, as nuPlan takes it: from each row on everybody keeps speed
/// and heading, looked at every 0.1 s over 3 s. None: nothing would be touched.
std::optional<Encounter> least_time_to_collision(const Drive& drive, const World& world,
                                                 const geometry::VehicleShape& vehicle);

/// Least time headway to a lead: gap over own speed, where that is 1 m/s or more. None: no lead.
std::optional<Encounter> least_headway(const Drive& drive);

/// Metres driven against the reference line.
double wrong_way_m(const Drive& drive);

}  // namespace roadbed::tools
