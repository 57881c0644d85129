#pragma once

#include <cstddef>
#include <vector>

#include "roadbed/tools/simulation/driven_way.h"
#include "roadbed/tools/simulation/traffic.h"

namespace roadbed::tools {

/// Part of a way on which the body would touch an obstacle.
struct Blocked {
  double from_m = 0.0, to_m = 0.0;  ///< of the rear axle, along the way
  std::size_t obstacle = 0;         ///< index in the world
};

/// Which parts of a way are blocked when: the s–t graph of the obstacles. Parts of one time are in
/// no order; those of different obstacles may overlap.
class WayOccupancy {
 public:
  static constexpr double kStep_s = 0.1;

  /// @param steps     of 0.1 s from `start_s` on; obstacles move as the world knows.
  /// @param margin_m  an obstacle this near to the body counts as touched.
  WayOccupancy(const DrivenWay& way, const Traffic& traffic, double start_s, int steps,
               double margin_m);

  /// At `step` · 0.1 s after the start, clamped to the last one.
  const std::vector<Blocked>& at(int step) const;

  bool is_blocked(int step, double distance_m) const;

 private:
  std::vector<std::vector<Blocked>> blocked_;
};

}  // namespace roadbed::tools
