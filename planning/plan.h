#pragma once

#include <limits>
#include <memory>

#include "roadbed/geometry/motion/vehicle_shape.h"
#include "roadbed/planning/lateral/candidate_grid.h"
#include "roadbed/planning/lateral/plan_types.h"

namespace roadbed::planning {

/// The cheapest feasible, collision-free candidate of the whole grid (paper section 3.2); among
/// equal ones is_preferred() decides. Obstacles and the corners of the body are looked at lazily,
/// cheapest candidate first.
///
/// Every candidate is driven over the longest candidate's length, past its own end at d_e, and
/// checked there too: a short one does not win because it ends before an obstacle.
/// @throws std::invalid_argument if an option or the start is not usable.
Plan plan_path(const PlanInput& input, const geometry::VehicleShape& vehicle,
               const PlanOptions& options = {});

/// End offsets that are asked for, of those of the grid.
struct EndOffsetRange {
  double least_d_m = -std::numeric_limits<double>::infinity();
  double most_d_m = std::numeric_limits<double>::infinity();
};

/// A planning cycle that may be asked more than once, with other safety margins or for some of its
/// end offsets only: what candidates cost and whether the vehicle can drive them does not depend on
/// that, and is found once.
class PlanningCycle {
 public:
  /// @param input, vehicle  kept by reference.
  /// @throws std::invalid_argument as plan_path().
  PlanningCycle(const PlanInput& input, const geometry::VehicleShape& vehicle,
                const PlanOptions& options = {});
  ~PlanningCycle();
  PlanningCycle(const PlanningCycle&) = delete;
  PlanningCycle& operator=(const PlanningCycle&) = delete;

  /// As plan_path() with these margins instead of the options'.
  /// @param ends  as a grid that reaches so far; Plan::candidates holds the whole one.
  /// @throws std::invalid_argument also if the grid has no such end.
  Plan plan(const SafetyMargins& margins, const EndOffsetRange& ends = {});

  /// The same with what became of every candidate that is asked for, for more work: the whole grid
  /// is judged anew.
  Plan plan_and_judge_all(const SafetyMargins& margins, const EndOffsetRange& ends = {}) const;

  const PlanInput& input() const;

  /// What became of the candidates of every `length_stride`-th length, with these margins and ends.
  /// @param plan  that was found with them.
  CandidateGrid judge(const SafetyMargins& margins, const EndOffsetRange& ends, const Plan& plan,
                      std::size_t length_stride = KeptCandidates{}.length_stride);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace roadbed::planning
