#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "roadbed/planning/behaviour/decision.h"
#include "roadbed/planning/speed/path_profile.h"
#include "roadbed/planning/speed/speed_search.h"
#include "roadbed/planning/speed/st_graph.h"

namespace roadbed::planning::inline behaviour {

struct CruiseForecastQuestion {
  const PathProfile& profile;
  const StGraph& occupancy;
  double speed_mps = 0.0, acceleration_mps2 = 0.0;
  double stop_m = 0.0;  ///< ahead, where the vehicle has to stop by a rule or at the goal
  const std::vector<bool>& no_matter;  ///< per obstacle: it follows, and keeps its distance itself
  const std::vector<bool>& crosses;    ///< per obstacle: it will have left the path, and is no lead
  std::optional<double> most_mps = {};
  std::span<const HiddenWalker> walkers = {};  ///< who may step out beside the path
};

struct CruiseForecast {
  SpeedSearchAnswer drive;         ///< without cost
  std::optional<std::size_t> met;  ///< obstacle, after `drive.free_until_s`; none: it is free
};

/// The drive that the cruise law will make of a path among what moves, as far as the occupancy
/// goes, in steps of 0.1 s: at most what the path wants, to a stop where one has to be made, and
/// closing up to whoever is ahead at each time as choose_speed() does. What is touched from the
/// start is not looked at.
CruiseForecast forecast_cruise(const CruiseForecastQuestion& question,
                               const DecisionOptions& options);

}  // namespace roadbed::planning::behaviour
