#include <fmt/format.h>
#include <fmt/ostream.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <new>
#include <optional>
#include <string>
#include <vector>

#include "roadbed/map/files/csv_field.h"
#include "roadbed/map/files/in_threads.h"
#include "roadbed/map/files/input_error.h"
#include "roadbed/map/files/json_text.h"
#include "roadbed/map/files/read_file.h"
#include "roadbed/map/files/visible_text.h"
#include "roadbed/map/storage/output_file.h"
#include "roadbed/map/storage/output_folder.h"
#include "roadbed/planning/audit/clearance_audit.h"
#include "roadbed/tools/cli/line_process.h"
#include "roadbed/tools/cli/progress_bar.h"
#include "roadbed/tools/commands/drives/commands.h"
#include "roadbed/tools/files/json.h"
#include "roadbed/tools/files/vehicle_file.h"
#include "roadbed/tools/report/drive_files.h"
#include "roadbed/tools/report/drive_mcap.h"
#include "roadbed/tools/simulation/scenario.h"

namespace roadbed::tools::inline commands::inline drives {
namespace {

namespace fs = std::filesystem;
using DrivenFile = decltype(DrivenScenario::files)::value_type;

/// The inputs of a drive cannot be read again where one was a stream.
bool can_replay(const DrivenScenario& driven) {
  return std::ranges::none_of(driven.record.sources, map::is_stream, &DriveSource::file);
}

/// Of what an earlier drive left, the solution, the record and the log go, too, where this drive
/// has none: nobody could tell that they are not this drive's.
map::OutputFolderOptions folder_options(bool force, const CommonOptions& common) {
  const auto is_dropped = [](const std::string& name) {
    return name == "solution.xml" || name == kDriveRecordName || name == kDriveLogName;
  };
  return {.force = force, .is_dropped = is_dropped, .inputs = common.input_files};
}

void write_files(const DrivenScenario& driven, const fs::path& place, map::OutputFolder& folder) {
  for (const auto& [name, bytes] : driven.files) folder.write(name, bytes);
  if (can_replay(driven)) {
    folder.write(kDriveRecordName, write_drive_record(driven.record, place));
  }
  folder.commit();
}

std::string timings_csv(const std::vector<double>& cycle_ms) {
  std::string csv = "cycle,wall_ms\n";
  for (std::size_t i = 0; i < cycle_ms.size(); ++i)
    csv += fmt::format("{},{:.3f}\n", i, cycle_ms[i]);
  return csv;
}

std::string seed_fault(const std::string& text) {
  return parse_seed(text) ? "" : "is no whole number from 0 to 2^53";
}

/// One scenario of many: what became of it.
struct ScenarioRow {
  fs::path file;
  std::string outcome = {}, text = {};
  double at_s = 0.0, slowest_ms = 0.0, median_ms = 0.0;
  bool is_good = false;
};

/// Scenarios right in the folder, by name, which is also that of a scenario's outputs.
std::vector<ScenarioRow> rows_of(const fs::path& folder) {
  std::vector<ScenarioRow> rows;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder)) {
    const std::string suffix = entry.path().extension().string();
    if (suffix == ".json" || suffix == ".xml") rows.push_back({.file = entry.path()});
  }
  const auto stem = [](const ScenarioRow& row) { return row.file.stem(); };
  std::ranges::sort(rows, {}, stem);
  const auto twice = std::ranges::adjacent_find(rows, {}, stem);
  if (twice != rows.end()) {
    throw map::InputError({.file = folder.string(),
                           .found = "two scenarios of the name " + twice->file.stem().string(),
                           .needed = "names that differ, not only in their suffix",
                           .remedy = "rename one"});
  }
  return rows;
}

void note_times(std::vector<double> cycle_ms, ScenarioRow& row) {
  if (cycle_ms.empty()) return;
  std::ranges::sort(cycle_ms);
  row.slowest_ms = cycle_ms.back();
  row.median_ms = cycle_ms[cycle_ms.size() / 2];
}

struct DriveOptions {
  fs::path output;
  DriveChoice choice;
  const CommonOptions& common;
  bool force;
};

/// Drives one; whatever is wrong with it is its own outcome.
/// @throws OutputError, std::bad_alloc  which say nothing of the scenario.
void drive_row(const DriveOptions& options, ScenarioRow& row) {
  try {
    const DrivenScenario driven = drive_scenario(row.file, options.choice, *options.common.inputs);
    const fs::path place = options.output / row.file.stem();
    map::OutputFolder folder(place, folder_options(options.force, options.common));
    write_files(driven, place, folder);
    row.outcome = to_string(driven.verdict.outcome);
    row.text = driven.verdict.text;
    row.at_s = driven.verdict.at_s;
    row.is_good = driven.verdict.outcome == Outcome::goal_reached;
    note_times(driven.cycle_ms, row);
  } catch (const map::OutputError&) {
    throw;
  } catch (const std::bad_alloc&) {
    throw;
  } catch (const std::exception& error) {
    row.outcome = "unusable";
    row.text = error.what();
  }
}

void drive_all(std::vector<ScenarioRow>& rows, const DriveOptions& options, ProgressBar& progress) {
  map::in_threads(rows.size(), options.common.threads, [&](std::size_t i) {
    drive_row(options, rows[i]);
    progress.done_one();
  });
}

std::string table_csv(const std::vector<ScenarioRow>& rows) {
  std::string csv = "scenario,outcome,at_s,text\n";
  for (const ScenarioRow& row : rows) {
    csv += fmt::format("{},{},{:.2f},{}\n", map::csv_field(row.file.stem().string()), row.outcome,
                       row.at_s, map::csv_field(row.text));
  }
  return csv;
}

class SimulateCommand : public Command {
 public:
  void declare(Arguments& arguments) override {
    arguments.description("Drive scenarios in a closed loop and report on them");
    arguments
        .add("SCENARIO", scenario_file_,
             "Scenario file (.json, or CommonRoad .xml), or a folder of them")
        .required()
        .reads(files_named_by_scenario)
        .ending(kScenarioEndings);
    arguments
        .add(
            "-o,--output", folder_,
            "Folder for trajectory.csv, cycles.jsonl, metrics.json, report.html, drive.svg and "
            "replay.json (for `plan DIR@T`), for CommonRoad solution.xml too; of a folder, one for "
            "each scenario, and drives.csv")
        .required()
        .writes("/");
    arguments
        .add("--timings", timings_file_, "File for the wall clock of each planning cycle (.csv)")
        .writes("");
    arguments.flag("-j,--json", json_, "Print the metrics as one JSON document");
    arguments.flag("--candidates", choice_.keeps_candidates,
                   "Keep what became of each candidate, for the report; takes longer");
    arguments.flag("--mcap", choice_.writes_mcap,
                   "Write drive.mcap, too, a log for Foxglove, Lichtblick and Rerun: poses, plans, "
                   "lanes, obstacles, occupied space");
    declare_knowledge(arguments);
    arguments.add(
        "--planner", choice_.planner_command,
        "Command of a planner that drives in place of roadbed's: for each cycle it reads a "
        "line of JSON and writes one, see tools/simulation/README.md");
    arguments
        .add("--planner-timeout", choice_.planner_limit_s,
             "Time that one of its answers may take [s]")
        .within(0.01, 3600.0)
        .with_default();
    declare_changes(arguments);
    arguments.flag("-f,--force", force_, "Replace outputs that exist");
    arguments.says_no_if("a drive does not reach its goal");
    arguments.example(
        "  roadbed simulate data/drive.json -o drive\n"
        "  roadbed simulate data/scenarios/stop_and_go.json --seed 7 -o drive_7\n"
        "  roadbed simulate data/scenarios/pass_car.json --mcap -o passed");
  }

  Exit run(const Streams& streams, const CommonOptions& common) override {
    if (!timings_file_.empty()) map::check_writable(timings_file_, force_);
    if (!choice_.planner_command.empty() && !common.is_alone) refuse_planner();
    read_changes();
    std::optional<NoPipeSignal> no_signal;  // of a planner that ends
    if (!choice_.planner_command.empty()) no_signal.emplace();
    return map::is_folder(scenario_file_) ? run_folder(streams, common) : run_one(streams, common);
  }

 private:
  /// Files of jobs may be a stranger's; nothing in them is run.
  [[noreturn]] void refuse_planner() const {
    throw map::InputError({.file = "planner",
                           .found = "is a command",
                           .needed = "roadbed's own planner in a job",
                           .remedy = "run `roadbed simulate --planner` by itself"});
  }

  void declare_knowledge(Arguments& arguments) {
    Argument predicts = arguments.flag(
        "--predict", predicts_,
        "Others are measured, tracked and foreseen; the default in roadbed's own scenarios");
    arguments
        .flag("--known-future", knows_future_,
              "What others will do is known; the default in CommonRoad's scenarios")
        .excludes(predicts);
  }

  void declare_changes(Arguments& arguments) {
    arguments
        .add("--vehicle", choice_.vehicle_file,
             std::string("Vehicle in place of the scenario's: ") + kVehicleSyntax +
                 "; of CommonRoad files there is no solution.xml then, as that names vehicle 2")
        .reads()
        .ending(".json .yaml");
    arguments
        .add("--noise", choice_.noise_file,
             "Noise of what is measured (.json, the keys of a scenario's noise), in place of the "
             "scenario's")
        .reads()
        .ending(".json");
    arguments.flag("--drop-ego-recording", choice_.changes.drops_ego_recording,
                   "Leave out the ego's own recording, an obstacle of its extent where it starts "
                   "(CommonRoad files)");
    arguments
        .add("--options", choice_.planner_file,
             "How to drive (.json): a style (gentle, normal, sporty), limits, and weights of the "
             "cost, in place of the scenario's")
        .reads()
        .ending(".json");
    arguments
        .add("--seed", seed_,
             "Seed of the noise in place of the scenario's: the same drive for the same seed; "
             "refused where there is no noise")
        .checked(seed_fault);
  }

  void read_changes() {
    choice_.read_files();
    if (predicts_ || knows_future_) choice_.predicts = predicts_;
    if (!seed_.empty()) choice_.changes.seed = parse_seed(seed_);
  }

  Exit run_one(const Streams& streams, const CommonOptions& common) const {
    map::OutputFolder folder(folder_, folder_options(force_, common));
    const DrivenScenario driven = drive_scenario(scenario_file_, choice_, *common.inputs);
    write_files(driven, folder_, folder);
    if (!timings_file_.empty()) {
      map::write_output(timings_file_, timings_csv(driven.cycle_ms), force_);
    }
    print_one(streams.out, driven);
    if (!common.quiet) {
      if (!can_replay(driven)) {
        fmt::print(streams.err, "note: no {}, as an input was a stream, gone once it is read\n",
                   kDriveRecordName);
      }
      fmt::print(streams.err, "wrote {}\n", (folder_ / "report.html").string());
    }
    return driven.verdict.outcome == Outcome::goal_reached ? Exit::ok : Exit::no;
  }

  void print_one(std::ostream& out, const DrivenScenario& driven) const {
    if (json_) {
      out << std::ranges::find(driven.files, "metrics.json", &DrivenFile::first)->second;
      return;
    }
    fmt::print(out, "{}: {}\n", driven.name, driven.verdict.text);
    if (driven.audit) {
      fmt::print(out, "occupancy: {}\n", planning::to_string(driven.audit->verdict));
    }
  }

  Exit run_folder(const Streams& streams, const CommonOptions& common) const {
    std::vector<ScenarioRow> rows = rows_of(scenario_file_);
    if (rows.empty()) {
      throw map::InputError({.file = scenario_file_.string(),
                             .found = "no scenario",
                             .needed = "files that end in .json or .xml",
                             .remedy = "give another folder"});
    }
    map::make_output_folder(folder_, force_);
    ProgressBar progress(rows.size(), !common.quiet && isatty(STDERR_FILENO) == 1);
    drive_all(rows, {folder_, choice_, common, force_}, progress);
    map::write_output(folder_ / "drives.csv", table_csv(rows), force_);
    if (!timings_file_.empty()) {
      map::write_output(timings_file_, folder_timings_csv(rows), force_);
    }
    json_ ? print_json(streams.out, rows) : print_table(streams.out, rows);
    const bool all_good = std::ranges::all_of(rows, &ScenarioRow::is_good);
    return all_good ? Exit::ok : Exit::no;
  }

  static std::string folder_timings_csv(const std::vector<ScenarioRow>& rows) {
    std::string csv = "scenario,median_ms,slowest_ms\n";
    for (const ScenarioRow& row : rows) {
      csv += fmt::format("{},{:.3f},{:.3f}\n", map::csv_field(row.file.stem().string()),
                         row.median_ms, row.slowest_ms);
    }
    return csv;
  }

  static void print_json(std::ostream& out, const std::vector<ScenarioRow>& rows) {
    Json drives = Json::array();
    for (const ScenarioRow& row : rows) {
      drives.push_back({{"scenario", row.file.stem().string()},
                        {"outcome", row.outcome},
                        {"at_s", row.at_s},
                        {"text", row.text}});
    }
    out << map::json_text(versioned("drives", {{"drives", drives}}), 2) << '\n';
  }

  static void print_table(std::ostream& out, const std::vector<ScenarioRow>& rows) {
    for (const ScenarioRow& row : rows) {
      fmt::print(out, "{:32} {:13} {}\n", map::one_line(row.file.stem().string()), row.outcome,
                 map::one_line(row.text));
    }
    fmt::print(out, "{} of {} reach their goal\n",
               std::ranges::count_if(rows, &ScenarioRow::is_good), rows.size());
  }

  fs::path scenario_file_, folder_, timings_file_;
  std::string seed_;
  bool json_ = false, force_ = false, predicts_ = false, knows_future_ = false;
  DriveChoice choice_;
};

}  // namespace

std::unique_ptr<Command> make_simulate_command() { return std::make_unique<SimulateCommand>(); }

}  // namespace roadbed::tools::commands::drives
