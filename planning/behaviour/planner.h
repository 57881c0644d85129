#pragma once

#include <memory>

#include "roadbed/planning/behaviour/lateral_replanner.h"
#include "roadbed/planning/behaviour/planner_types.h"

namespace roadbed::planning::inline behaviour {

/// Plans path and speed, once every 0.1 s.
///
///     who is there ─▶ what will be where ─▶ hypotheses: which line, past or behind whom
///                                                │ best path of the grid, best speed in s–t
///                                                ▼
///                           the first that is free, else the cheapest ─▶ path, acceleration
///
/// Where the task ends at a place, the speed is that of the cruise law, as long as a forecast of
/// it meets nothing; where the goal has a time, or the forecast meets somebody, a search over the
/// s–t graph finds it.
class Planner {
 public:
  explicit Planner(const PlannerSetup& setup);  ///< keeps what that refers to
  ~Planner();
  Planner(Planner&&) noexcept;
  Planner& operator=(Planner&&) noexcept;

  PlannerCommand decide(const PlannerView& view);  ///< one cycle

  /// The path to follow; of the last decision.
  const LateralReplanner& replanner() const;

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace roadbed::planning::behaviour
