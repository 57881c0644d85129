#include "roadbed/tools/report/drive_replay.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>

#include "roadbed/map/files/input_error.h"
#include "roadbed/map/files/read_file.h"
#include "roadbed/tools/cli/build_id.h"
#include "roadbed/tools/files/trajectory_csv.h"
#include "roadbed/tools/report/drive_files.h"
#include "roadbed/tools/report/drive_record.h"
#include "roadbed/tools/simulation/cycle_log.h"

namespace roadbed::tools::inline report {
namespace {

namespace fs = std::filesystem;

DriveChoice choice_of(const DriveRecord& record) {
  DriveChoice choice{
      .predicts = record.predicts,
      .changes = {.seed = record.seed, .drops_ego_recording = record.drops_ego_recording},
      .vehicle_file = record.file_of("vehicle"),
      .noise_file = record.file_of("noise"),
      .planner_file = record.file_of("planner options")};
  choice.read_files();
  return choice;
}

/// The cycle that begins at a time, or last before. Each left a row, and the drive's end another.
std::size_t cycle_at(const DriveTime& time, const geometry::Trajectory& driven) {
  if (!(time.t_s >= 0.0 && time.t_s <= driven.end_s())) {
    throw map::InputError({.file = time.folder.string(),
                           .found = fmt::format("has no cycle at {} s", time.t_s),
                           .needed = fmt::format("0 to {} s", driven.end_s()),
                           .remedy = "give a time of the drive"});
  }
  const auto cycle =
      static_cast<std::size_t>(std::floor(time.t_s / geometry::kLongitudinal.cycle_s + 1e-9));
  return std::min(cycle, std::max<std::size_t>(2, driven.points().size()) - 2);
}

class Comparison {
 public:
  Comparison(const fs::path& folder, const DriveRecord& record)
      : folder_(folder), record_(record) {}

  /// That a file begins with these bytes.
  void check(const std::string& name, const std::string& again) const {
    const std::string there = map::read_file(folder_ / name);
    const auto differs = std::ranges::mismatch(again, there).in1;
    if (differs == again.end()) return;
    refuse(name, 1 + std::count(again.begin(), differs, '\n'));
  }

  [[noreturn]] void refuse(const std::string& name, std::ptrdiff_t line) const {
    const std::string now = name_and_version();
    throw map::InputError(
        {.file = (folder_ / name).string(),
         .place = fmt::format("{}", line),
         .found = "differs from the same drive, driven again",
         .needed = now == record_.program
                       ? "the bytes that simulate wrote"
                       : fmt::format("{}, which drove it; this is {}", record_.program, now),
         .remedy = "drive again with `roadbed simulate`"});
  }

 private:
  const fs::path& folder_;
  const DriveRecord& record_;
};

}  // namespace

bool names_drive_time(const std::string& text) {
  return text.find('@') != std::string::npos && !map::is_there(text);
}

DriveTime parse_drive_time(const std::string& text) {
  const std::size_t at = text.rfind('@');
  double t_s = 0.0;
  const char* const end = text.data() + text.size();
  const auto parsed = std::from_chars(text.data() + at + 1, end, t_s);
  if (parsed.ec != std::errc() || parsed.ptr != end || !std::isfinite(t_s)) {
    throw map::InputError({.file = text,
                           .found = fmt::format("\"{}\" is no time", text.substr(at + 1)),
                           .needed = "seconds of the drive",
                           .remedy = "write DIR@T, as drive@4.2"});
  }
  return {text.substr(0, at), t_s};
}

void replay_cycle(const DriveTime& time, const Inputs& inputs,
                  const std::function<void(const ReplayedCycle&)>& use) {
  const DriveRecord record = read_drive_record(time.folder);
  if (record.is_outside) {
    throw map::InputError({.file = time.folder.string(),
                           .found = "was driven by another planner, given by --planner",
                           .needed = "a drive by roadbed's own",
                           .remedy = "look at cycles.jsonl and the report"});
  }
  const std::size_t last = cycle_at(time, read_trajectory_csv(time.folder / "trajectory.csv"));
  check_sources(record);
  const DriveChoice choice = choice_of(record);
  with_scenario(record.file_of("scenario"), choice, inputs, [&](const ReadyDrive& ready) {
    const Drive again =
        drive(ready.scenario, ready.world, {.predicts = record.predicts, .last_cycle = last});
    const Comparison comparison(time.folder, record);
    comparison.check("trajectory.csv", write_trajectory_csv(again.trajectory));
    comparison.check("cycles.jsonl", cycle_log(again));
    const auto row = static_cast<std::ptrdiff_t>(again.trajectory.points().size());
    if (!again.explained) comparison.refuse("trajectory.csv", row + 2);
    use({ready.scenario, ready.world, again.cycles.back(), again.samples.back(), *again.explained});
  });
}

}  // namespace roadbed::tools::report
