#pragma once

#include "roadbed/control/course.h"

namespace roadbed::control {

// The courses of the paper's two vehicle tests (Fig. 14), between straight stretches of one second
// before and three seconds after. Corners are quintic Béziers of the gentle gaps (5, 5, 4 m); where
// a speed asks for it they are made larger, so that the lateral acceleration on them stays within
// 3 m/s²: nobody turns at a crossroad at 30 m/s.

/// A right turn at a crossroad.
/// @throws std::invalid_argument if the speed is not positive, here and below.
Course right_turn_course(double speed_mps);

/// Four corners to alternate sides, by 40° each, with a half one before and after.
Course zig_zag_course(double speed_mps);

}  // namespace roadbed::control
