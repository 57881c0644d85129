#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "roadbed/planning/audit/clearance_audit.h"
#include "roadbed/tools/cli/inputs.h"
#include "roadbed/tools/report/drive_record.h"
#include "roadbed/tools/simulation/drive.h"
#include "roadbed/tools/simulation/scenario.h"
#include "roadbed/tools/simulation/world.h"

namespace roadbed::tools::inline report {

/// A drive and everything that is written of it.
struct DrivenScenario {
  std::string name;
  DriveVerdict verdict;
  std::optional<planning::AuditReport> audit;
  std::vector<std::pair<std::string, std::string>> files;  ///< name and bytes, for one folder
  DriveRecord record;                                      ///< for the same
  std::vector<double> cycle_ms;                            ///< wall clock of each planning cycle
  Drive drive;  ///< but for what the last cycle was decided on, which sees the world
};

/// How a scenario is driven.
struct DriveChoice {
  /// Others are measured and foreseen, not known by their true future; without a word those of
  /// roadbed's own scenarios are, those of CommonRoad's are not.
  std::optional<bool> predicts = {};
  bool keeps_candidates = false;  ///< the report shows what became of each candidate
  bool writes_mcap = false;       ///< drive.mcap as well
  ScenarioChanges changes = {};   ///< of what the file says
  std::filesystem::path vehicle_file = {}, noise_file = {}, planner_file = {};  ///< their sources
  OutsidePlanner outside_planner = {};  ///< that drives in place of roadbed's
  std::string planner_command = {};     ///< of the process that does, one for each drive
  double planner_limit_s = 60.0;        ///< that an answer of it may take

  /// Reads these files into the changes.
  /// @throws InputError if one is unusable.
  void read_files();
};

/// A scenario that is ready to be driven; of a CommonRoad file with its problem, else without.
struct ReadyDrive {
  Scenario& scenario;
  World& world;
  const CommonRoadDrive* problem = nullptr;
};

/// Reads a scenario file, roadbed's own or CommonRoad's, for `use`.
/// @throws InputError if the scenario is unusable.
void with_scenario(const std::filesystem::path& file, const DriveChoice& choice,
                   const Inputs& inputs, const std::function<void(const ReadyDrive&)>& use);

/// Reads a scenario file, drives it, and makes its outputs: trajectory.csv, cycles.jsonl,
/// metrics.json, report.html, drive.svg, replay.json, where it is asked for drive.mcap, and for
/// CommonRoad solution.xml, unless the vehicle is another than the one that it names.
/// @throws InputError if the scenario is unusable.
DrivenScenario drive_scenario(const std::filesystem::path& file, const DriveChoice& choice = {},
                              const Inputs& inputs = Inputs());

}  // namespace roadbed::tools::report
