#include <fmt/format.h>
#include <fmt/ostream.h>
#include <xxhash.h>

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "roadbed/map/read_file.h"
#include "roadbed/planning/audit.h"
#include "roadbed/tools/command.h"
#include "roadbed/tools/report/from_drive.h"
#include "roadbed/tools/report/report.h"
#include "roadbed/tools/report/scene_svg.h"
#include "roadbed/tools/simulation/closed_loop.h"
#include "roadbed/tools/simulation/metrics.h"
#include "roadbed/tools/support/output_file.h"
#include "roadbed/tools/support/trajectory_csv.h"

namespace roadbed::tools {
namespace {

namespace fs = std::filesystem;

ReportSource source(const std::string& role, const fs::path& file) {
  const std::string bytes = map::read_file(file);
  return {.role = role,
          .name = file.filename().string(),
          .xxhash = fmt::format("{:016x}", XXH3_64bits(bytes.data(), bytes.size()))};
}

std::vector<ReportSource> sources_of(const Scenario& scenario) {
  std::vector<ReportSource> sources{source("scenario", scenario.file),
                                    source("map", scenario.map_file)};
  for (const fs::path& file : scenario.occupancy_files) sources.push_back(source("cloud", file));
  return sources;
}

std::optional<planning::AuditReport> audit_of(const Scenario& scenario, const World& world,
                                              const Drive& drive) {
  if (!world.field) return std::nullopt;
  return planning::audit(*world.field, drive.trajectory, scenario.vehicle);
}

class SimulateCommand : public Command {
 public:
  void declare(Arguments& arguments) override {
    arguments.description("Drive a scenario in a closed loop and report on it");
    arguments.add("SCENARIO", scenario_file_, "Scenario file (.json)").required();
    arguments
        .add("-o,--output", folder_,
             "Folder for trajectory.csv, metrics.json, report.html and drive.svg")
        .required();
    arguments.add("--timings", timings_file_,
                  "File for the wall clock of each planning cycle (.csv)");
    arguments.flag("--force", force_, "Replace outputs that exist");
    arguments.example("  roadbed simulate data/drive.json -o drive");
  }

  Exit run(const Streams& streams, const CommonOptions& common) override {
    if (!timings_file_.empty()) check_writable(timings_file_, force_);
    const Scenario scenario = read_scenario(scenario_file_);
    const World world = make_world(scenario);
    make_output_folder(folder_, force_);
    std::string timings = "cycle,wall_ms\n";
    int cycle = 0;
    const Drive driven =
        drive(scenario, world,
              {.on_cycle = [&](double ms) { timings += fmt::format("{},{:.3f}\n", cycle++, ms); }});
    const auto audit = audit_of(scenario, world, driven);
    write(scenario, world, driven, audit);
    if (!timings_file_.empty()) write_output(timings_file_, timings);
    fmt::print(streams.out, "{}: {}\n", scenario.name, driven.verdict.text);
    if (audit) fmt::print(streams.out, "occupancy: {}\n", planning::name(audit->verdict));
    if (!common.quiet) {
      fmt::print(streams.err, "wrote {}\n", (folder_ / "report.html").string());
    }
    return driven.verdict.outcome == Outcome::goal_reached ? Exit::ok : Exit::failed;
  }

 private:
  void write(const Scenario& scenario, const World& world, const Drive& driven,
             const std::optional<planning::AuditReport>& audit) const {
    const ReportInput report = report_of(
        scenario, world, driven,
        {.command = fmt::format("roadbed simulate {} -o DIR", scenario_file_.filename().string()),
         .version = "roadbed " ROADBED_VERSION,
         .sources = sources_of(scenario),
         .audit = audit});
    write_output(folder_ / "trajectory.csv", write_trajectory_csv(driven.trajectory));
    write_output(folder_ / "metrics.json",
                 metrics_of(scenario, world, driven, audit).dump(2) + "\n");
    write_output(folder_ / "report.html", drive_report_html(report));
    write_output(folder_ / "drive.svg", drive_scene_svg(report));
  }

  fs::path scenario_file_, folder_, timings_file_;
  bool force_ = false;
};

}  // namespace

std::unique_ptr<Command> make_simulate_command() { return std::make_unique<SimulateCommand>(); }

}  // namespace roadbed::tools
