#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "roadbed/planning/speed/speed_question.h"
#include "roadbed/planning/speed/st_graph.h"

namespace roadbed::planning::inline speed {

/// A drive on the s–t graph that it was judged by, every half a second, for people to look at.
struct StPicture {
  static constexpr double kStep_s = 0.5;

  /// Where the body would touch an obstacle, with the margin that is kept from it.
  struct Part {
    std::uint16_t step = 0;          ///< the time from now, in steps
    float from_m = 0.0, to_m = 0.0;  ///< of the rear axle along the path
    std::size_t obstacle = 0;        ///< index in the world, or StInterval::kNoObstacle
  };
  std::vector<Part> parts;     ///< by time; those that the drive is nowhere near are left out
  std::vector<float> drive_m;  ///< where the drive is along the path, one per step
};

/// @param drive  from now on, by time.
StPicture st_picture(const StGraph& graph, std::span<const SpeedState> drive);

}  // namespace roadbed::planning::speed
