#pragma once

#include "roadbed/geometry/motion/vehicle_shape.h"

namespace roadbed::control {

inline const geometry::VehicleShape kVehicle;  // the default one

}  // namespace roadbed::control
