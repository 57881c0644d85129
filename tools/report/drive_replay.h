#pragma once

#include <filesystem>
#include <functional>
#include <string>

#include "roadbed/planning/behaviour/lateral_replanner.h"
#include "roadbed/tools/cli/inputs.h"
#include "roadbed/tools/simulation/drive.h"
#include "roadbed/tools/simulation/scenario.h"
#include "roadbed/tools/simulation/world.h"

namespace roadbed::tools::inline report {

/// A cycle of a drive that is there, planned again.
struct ReplayedCycle {
  const Scenario& scenario;
  const World& world;
  const DriveCycle& cycle;
  const DriveSample& row;
  const planning::ExplainedPlan& explained;
};

/// A time of a drive, as `DIR@T` names it.
struct DriveTime {
  std::filesystem::path folder;
  double t_s = 0.0;
};

/// Whether a text is `DIR@T`: it has an `@`, and there is no file of that name.
bool names_drive_time(const std::string& text);

/// @throws InputError if what stands after the last `@` is no time. @pre names_drive_time(text)
DriveTime parse_drive_time(const std::string& text);

/// Drives anew up to a time what `simulate` drove, and hands on the cycle that begins then, or last
/// before.
/// @throws InputError if there is no such drive or time, a file that it was made from has changed,
///         or what is driven differs by a byte from the folder's rows and cycles up to then.
void replay_cycle(const DriveTime& time, const Inputs& inputs,
                  const std::function<void(const ReplayedCycle&)>& use);

}  // namespace roadbed::tools::report
