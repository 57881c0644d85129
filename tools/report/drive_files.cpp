#include "roadbed/tools/report/drive_files.h"

#include <fmt/format.h>

#include "roadbed/map/files/input_error.h"
#include "roadbed/planning/audit/audit_drive.h"
#include "roadbed/tools/audit/certificate_json.h"
#include "roadbed/tools/cli/build_id.h"
#include "roadbed/tools/files/trajectory_csv.h"
#include "roadbed/tools/report/from_drive.h"
#include "roadbed/tools/report/report.h"
#include "roadbed/tools/simulation/drive.h"
#include "roadbed/tools/simulation/metrics.h"
#include "roadbed/tools/simulation/world.h"

namespace roadbed::tools::inline report {
namespace {

namespace fs = std::filesystem;

ReportSource source(const std::string& role, const fs::path& file) {
  return {.role = role, .name = file.filename().string(), .sha256 = certified_file(file).sha256};
}

std::vector<ReportSource> sources_of(const Scenario& scenario, const DriveChoice& choice) {
  std::vector<ReportSource> sources{source("scenario", scenario.file)};
  if (scenario.map_file != scenario.file) sources.push_back(source("map", scenario.map_file));
  for (const fs::path& file : scenario.occupancy_files) sources.push_back(source("cloud", file));
  if (!choice.vehicle_file.empty()) sources.push_back(source("vehicle", choice.vehicle_file));
  if (!choice.noise_file.empty()) sources.push_back(source("noise", choice.noise_file));
  if (!choice.planner_file.empty()) {
    sources.push_back(source("planner options", choice.planner_file));
  }
  return sources;
}

std::optional<planning::AuditReport> audit_of(const Scenario& scenario, const World& world,
                                              const Drive& drive) {
  if (!world.field) return std::nullopt;
  return planning::audit_drive(world.field, drive.trajectory,
                               {.parts = {geometry::body_of(scenario.vehicle)}})
      .report;
}

// As one would type it beside the inputs.
std::string command_of(const Scenario& scenario, const DriveChoice& choice) {
  std::string command = "roadbed simulate " + scenario.file.filename().string();
  if (choice.predicts) command += " --predict";
  if (choice.keeps_candidates) command += " --candidates";
  if (!choice.vehicle_file.empty()) {
    command += " --vehicle " + choice.vehicle_file.filename().string();
  }
  if (!choice.noise_file.empty()) command += " --noise " + choice.noise_file.filename().string();
  if (choice.changes.drops_ego_recording) command += " --drop-ego-recording";
  if (!choice.planner_file.empty()) {
    command += " --options " + choice.planner_file.filename().string();
  }
  if (choice.changes.seed) command += fmt::format(" --seed {}", *choice.changes.seed);
  return command + " -o DIR";
}

struct Driven {
  DrivenScenario result;
  Drive drive;
};

Driven drive_and_describe(const Scenario& scenario, World& world, const DriveChoice& choice) {
  Driven driven;
  DrivenScenario& result = driven.result;
  driven.drive =
      drive(scenario, world,
            {.planner = {.predicts = choice.predicts, .keeps_candidates = choice.keeps_candidates},
             .on_cycle = [&](double ms) { result.cycle_ms.push_back(ms); }});
  result.name = scenario.name;
  result.verdict = driven.drive.verdict;
  result.audit = audit_of(scenario, world, driven.drive);
  const ReportInput report = report_of(scenario, world, driven.drive,
                                       {.command = command_of(scenario, choice),
                                        .version = name_and_version(),
                                        .sources = sources_of(scenario, choice),
                                        .audit = result.audit});
  result.files = {
      {"trajectory.csv", write_trajectory_csv(driven.drive.trajectory)},
      {"metrics.json", metrics_of(scenario, world, driven.drive, result.audit).dump(2) + "\n"},
      {"report.html", drive_report_html(report)},
      {"drive.svg", drive_scene_svg(report)}};
  return driven;
}

/// An .xml that is no CommonRoad scenario is not meant to be JSON.
void refuse_other_xml(const fs::path& file) {
  if (file.extension() != ".xml" || !fs::exists(file)) return;
  throw map::InputError({.file = file.string(),
                         .found = "no <commonRoad> element",
                         .needed = "a CommonRoad scenario",
                         .remedy = "give another file; roadbed's own scenarios end in .json"});
}

}  // namespace

DrivenScenario drive_scenario(const fs::path& file, const DriveChoice& choice,
                              const Inputs& inputs) {
  if (is_common_road(file)) {
    CommonRoadDrive problem = read_common_road_drive(file, choice.changes, inputs);
    Driven driven = drive_and_describe(problem.scenario, problem.world, choice);
    if (!choice.changes.vehicle) {
      driven.result.files.emplace_back("solution.xml", solution_xml(problem, driven.drive));
    }
    return std::move(driven.result);
  }
  refuse_other_xml(file);
  Scenario scenario = read_scenario(file);
  choice.changes.apply_to(scenario);
  World world = make_world(scenario, inputs);
  return drive_and_describe(scenario, world, choice).result;
}

}  // namespace roadbed::tools::report
