#pragma once

#include <limits>
#include <memory>
#include <span>
#include <vector>

#include "roadbed/planning/lateral/plan.h"

namespace roadbed::planning::inline lateral {

/// End offsets that are looked at, of those of the grid.
struct EndRange {
  double least_d_m = -std::numeric_limits<double>::infinity();
  double most_d_m = std::numeric_limits<double>::infinity();
};

/// A planning cycle that may be asked more than once, with less room to keep or for some of its
/// ends only: what candidates cost and whether the vehicle can drive them does not depend on that,
/// and is found once.
class PlanCycle {
 public:
  /// @param input, vehicle  kept by reference.
  /// @throws std::invalid_argument as plan_path().
  PlanCycle(const PlanInput& input, const geometry::VehicleShape& vehicle,
            const PlanOptions& options = {});
  ~PlanCycle();
  PlanCycle(const PlanCycle&) = delete;
  PlanCycle& operator=(const PlanCycle&) = delete;

  /// As plan_path() with the margin and the clearance of `room` instead of the options'.
  /// @param ends  as a grid that reaches so far; Plan::candidates holds the whole one.
  /// @throws std::invalid_argument also if the grid has no such end.
  Plan plan(const Room& room, const EndRange& ends = {});

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// Whether something was rejected because it would touch something: the way is not free, and less
/// room to the edges will not help.
bool is_in_the_way(const Plan& plan);

/// The plans of a cycle with one room after the other, up to the first that holds a way, or that
/// something is in the way of.
/// @pre there is a room
std::vector<Plan> plan_in_rooms(PlanCycle& cycle, std::span<const Room> rooms);

}  // namespace roadbed::planning::lateral
