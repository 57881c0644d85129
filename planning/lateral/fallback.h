#pragma once

#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "roadbed/planning/lateral/path_drive.h"
#include "roadbed/planning/lateral/plan.h"

namespace roadbed::planning::inline lateral {

/// What a cycle resorts to when nothing can be driven as asked, in this order.
enum class Resort {
  none,             ///< as asked
  wider_grid,       ///< farther to the sides, and on shorter candidates
  beyond_the_edge,  ///< the body may leave the corridor a little
  stop,             ///< along the path that is being driven
};
std::string_view name(Resort resort);

struct FallbackOptions {
  double wider = 1.5;    ///< the wider grid reaches so many times as far to the sides
  double shorter = 0.5;  ///< its shortest candidates are so many times as long
  /// How far the body may leave the corridor [m]: in the sharpest turns of real maps no body keeps
  /// to its lane. Not tried where candidates collide: nothing is passed outside the road.
  std::vector<double> beyond_the_edge_m = {0.3, 0.6};
  /// Of the stop, gentlest first [m/s²].
  std::vector<double> decelerations_mps2 = {1.5, 3.0, 6.0};
};

/// One look at a grid, and what became of its candidates.
struct Attempt {
  Resort resort = Resort::none;
  double beyond_the_edge_m = 0.0;
  RejectionCounts rejected{};
};

/// A stop along the path that is being driven.
struct ControlledStop {
  double deceleration_mps2 = 0.0;
  /// Least clearance that it keeps, of those asked for: the whole one or none; empty if it touches
  /// something however hard it brakes.
  std::optional<double> clearance_m;
  geometry::Trajectory trajectory;  ///< to standstill, and on to the horizon
};

/// What to drive in any case.
struct PlanOrStop {
  Resort resort = Resort::none;
  double beyond_the_edge_m = 0.0;      ///< that the body was allowed to leave the corridor
  Plan plan;                           ///< of the last attempt; `chosen` unless it is a stop
  std::optional<ControlledStop> stop;  ///< if, and only if, nothing was chosen
  std::vector<Attempt> attempts;       ///< one or more, in order, with counts per cause
  std::string reason;                  ///< why not as asked; empty if it is

  /// The chosen drive, or the stop.
  const geometry::Trajectory& trajectory() const {
    return stop ? stop->trajectory : plan.trajectory;
  }
};

/// plan_path(), and when nothing is feasible: a wider grid, then past the corridor's edges, then a
/// stop along the previous path. The gentlest stop that keeps the clearance is taken, then the
/// gentlest one that touches nothing, then the hardest. Without a previous path d becomes what it
/// is now over `min_l_m`. A stop is not held to the road or to lateral acceleration: it is what is
/// left.
/// @param previous  the path that is being driven; may be empty.
/// @throws std::invalid_argument as plan_path(), and if a fallback option is not usable.
PlanOrStop plan_or_stop(const PlanInput& input, const LateralPath& previous,
                        const geometry::VehicleShape& vehicle, const PlanOptions& options = {},
                        const FallbackOptions& fallback = {});

}  // namespace roadbed::planning::lateral
