#pragma once

#include <ostream>
#include <string>

#include "roadbed/geometry/motion/vehicle_shape.h"
#include "roadbed/map/storage/output_folder.h"
#include "roadbed/planning/lateral/plan_types.h"
#include "roadbed/tools/files/json.h"
#include "roadbed/tools/report/drive_replay.h"
#include "roadbed/tools/simulation/world.h"

namespace roadbed::tools::inline commands::inline drives {

/// A planning cycle, and what it was planned in.
struct PlannedCycle {
  const World& world;
  const geometry::VehicleShape& vehicle;
  const planning::PlanInput& input;
  const planning::Plan& plan;  ///< with its candidates
  const planning::CostTerms& weights;
  std::string title;
};

/// Writes candidates.csv, plan.svg and, if there is one, the plan's trajectory.csv.
/// @throws OutputError if they cannot be written.
void write_plan(const PlannedCycle& cycle, map::OutputFolder& folder);

Json plan_json(const planning::Plan& plan);

/// @param explain  with each term's share of the cost.
void print_plan(std::ostream& out, const PlannedCycle& cycle, bool explain);

/// What was decided in a cycle of a drive, and what became of each hypothesis.
void print_decision(std::ostream& out, const ReplayedCycle& cycle);

}  // namespace roadbed::tools::commands::drives
