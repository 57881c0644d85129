#include "roadbed/tools/report/drive_files.h"

#include <fmt/format.h>

#include "roadbed/map/files/input_error.h"
#include "roadbed/map/files/json_text.h"
#include "roadbed/map/files/read_file.h"
#include "roadbed/planning/audit/audit_drive.h"
#include "roadbed/tools/audit/certificate_json.h"
#include "roadbed/tools/cli/build_id.h"
#include "roadbed/tools/files/trajectory_csv.h"
#include "roadbed/tools/files/vehicle_file.h"
#include "roadbed/tools/report/drive_mcap.h"
#include "roadbed/tools/report/from_drive.h"
#include "roadbed/tools/report/report.h"
#include "roadbed/tools/simulation/cycle_log.h"
#include "roadbed/tools/simulation/drive.h"
#include "roadbed/tools/simulation/metrics.h"
#include "roadbed/tools/simulation/world.h"

namespace roadbed::tools::inline report {
namespace {

namespace fs = std::filesystem;

std::vector<DriveSource> sources_of(const Scenario& scenario, const DriveChoice& choice) {
  std::vector<DriveSource> sources;
  const auto add = [&](const std::string& role, const fs::path& file) {
    if (!file.empty()) sources.push_back({role, file, hashed_input(file).sha256});
  };
  add("scenario", scenario.file);
  if (scenario.map_file != scenario.file) add("map", scenario.map_file);
  for (const fs::path& file : scenario.occupancy_files) add("cloud", file);
  add("vehicle", choice.vehicle_file.empty() ? scenario.vehicle_file : choice.vehicle_file);
  add("noise", choice.noise_file);
  add("obstacles", scenario.obstacles_file);
  for (const ScenarioObstacle& obstacle : scenario.obstacles) {
    if (const auto* drove = std::get_if<RecordedObstacle>(&obstacle.motion)) {
      if (map::is_file(drove->file)) add("obstacles", drove->file);
    }
  }
  add("planner options", choice.planner_file);
  return sources;
}

DriveRecord record_of(const Scenario& scenario, const DriveChoice& choice, bool predicts) {
  return {.program = name_and_version(),
          .sources = sources_of(scenario, choice),
          .predicts = predicts,
          .drops_ego_recording = choice.changes.drops_ego_recording,
          .is_outside = choice.outside_planner || !choice.planner_command.empty(),
          .seed = choice.changes.seed};
}

std::vector<ReportSource> shown(const std::vector<DriveSource>& sources) {
  std::vector<ReportSource> shown;
  for (const auto& [role, file, sha256] : sources) {
    shown.push_back({.role = role, .name = file.filename().string(), .sha256 = sha256});
  }
  return shown;
}

std::optional<planning::AuditReport> audit_of(const Scenario& scenario, const World& world,
                                              const Drive& drive) {
  if (!world.field) return std::nullopt;
  return planning::audit_drive(world.field, drive.trajectory,
                               {.parts = {geometry::body_of(scenario.vehicle)}})
      .report;
}

std::string quoted(const std::string& text) {
  std::string words = "'";
  for (const char letter : text) words += letter == '\'' ? "'\\''" : std::string(1, letter);
  return words + "'";
}

// As one would type it beside the inputs.
std::string command_of(const Scenario& scenario, const DriveChoice& choice) {
  std::string command = "roadbed simulate " + scenario.file.filename().string();
  if (choice.predicts) command += *choice.predicts ? " --predict" : " --known-future";
  if (choice.keeps_candidates) command += " --candidates";
  if (!choice.vehicle_file.empty()) {
    command += " --vehicle " + choice.vehicle_file.filename().string();
  }
  if (!choice.noise_file.empty()) command += " --noise " + choice.noise_file.filename().string();
  if (choice.changes.drops_ego_recording) command += " --drop-ego-recording";
  if (!choice.planner_file.empty()) {
    command += " --options " + choice.planner_file.filename().string();
  }
  if (!choice.planner_command.empty()) {
    command += fmt::format(" --planner {}", quoted(choice.planner_command));
  }
  if (choice.changes.seed) command += fmt::format(" --seed {}", *choice.changes.seed);
  return command + " -o DIR";
}

bool predicts(const ReadyDrive& ready, const DriveChoice& choice) {
  return choice.predicts.value_or(ready.problem == nullptr);
}

OutsidePlanner planner_of(const DriveChoice& choice) {
  if (choice.planner_command.empty()) return choice.outside_planner;
  return planner_process(choice.planner_command, choice.planner_limit_s);
}

DrivenScenario drive_and_describe(const ReadyDrive& ready, const DriveChoice& choice) {
  const auto& [scenario, world, problem] = ready;
  DrivenScenario result;
  result.record = record_of(scenario, choice, predicts(ready, choice));
  result.drive = drive(scenario, world,
                       {.planner = {.keeps_candidates = choice.keeps_candidates},
                        .predicts = result.record.predicts,
                        .on_cycle = [&](double ms) { result.cycle_ms.push_back(ms); },
                        .outside_planner = planner_of(choice)});
  const Drive& driven = result.drive;
  result.name = scenario.name;
  result.verdict = driven.verdict;
  result.audit = audit_of(scenario, world, driven);
  const ReportInput report = report_of(scenario, world, driven,
                                       {.command = command_of(scenario, choice),
                                        .version = result.record.program,
                                        .sources = shown(result.record.sources),
                                        .audit = result.audit});
  result.files = {
      {"trajectory.csv", write_trajectory_csv(driven.trajectory)},
      {"cycles.jsonl", cycle_log(driven)},
      {"metrics.json", map::json_text(metrics_of(scenario, world, driven, result.audit), 2) + "\n"},
      {"report.html", drive_report_html(report)},
      {"drive.svg", drive_scene_svg(report)}};
  if (choice.writes_mcap && !driven.trajectory.empty()) {
    DriveSpace space;
    space.occupancy = world.occupancy.get();
    space.audit = result.audit;
    result.files.emplace_back(kDriveLogName, drive_mcap(report, space));
  }
  if (problem != nullptr && !choice.changes.vehicle) {
    result.files.emplace_back("solution.xml", solution_xml(*problem, driven));
  }
  return result;
}

/// An .xml that is no CommonRoad scenario is not meant to be JSON.
void refuse_other_xml(const fs::path& file) {
  if (file.extension() != ".xml" || !map::is_there(file)) return;
  throw map::InputError({.file = file.string(),
                         .found = "no <commonRoad> element",
                         .needed = "a CommonRoad scenario",
                         .remedy = "give another file; roadbed's own scenarios end in .json"});
}

}  // namespace

void DriveChoice::read_files() {
  if (!vehicle_file.empty()) changes.vehicle = read_vehicle_shape(vehicle_file);
  if (!noise_file.empty()) changes.noise = read_noise_json(noise_file);
  if (!planner_file.empty()) changes.planner = read_planner_options(planner_file);
}

void with_scenario(const fs::path& file, const DriveChoice& choice, const Inputs& inputs,
                   const std::function<void(const ReadyDrive&)>& use) {
  if (is_common_road(file)) {
    CommonRoadDrive problem = read_common_road_drive(file, choice.changes, inputs);
    use({problem.scenario, problem.world, &problem});
    return;
  }
  refuse_other_xml(file);
  Scenario scenario = read_scenario(file);
  choice.changes.apply_to(scenario);
  World world = make_world(scenario, inputs);
  use({scenario, world});
}

DrivenScenario drive_scenario(const fs::path& file, const DriveChoice& choice,
                              const Inputs& inputs) {
  DrivenScenario driven;
  with_scenario(file, choice, inputs,
                [&](const ReadyDrive& ready) { driven = drive_and_describe(ready, choice); });
  return driven;
}

}  // namespace roadbed::tools::report
