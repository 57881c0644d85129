// `plan DIR@T` as a user runs it.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>
#include <vector>

#include "roadbed/tests/support/program_run.h"
#include "roadbed/tests/support/real_data.h"
#include "roadbed/tools/files/trajectory_csv.h"

namespace roadbed::tests {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;
using testing::HasSubstr;

std::vector<std::string> lines_of(const fs::path& file) {
  std::vector<std::string> lines;
  std::istringstream stream(bytes_of(file));
  for (std::string line; std::getline(stream, line);) lines.push_back(line);
  return lines;
}

class PlanReplay : public testing::Test {
 protected:
  ProgramRun simulate(const std::string& scenario, std::vector<std::string> more = {}) {
    more.insert(more.begin(), {"simulate", scenario, "-o", drive().string(), "--quiet"});
    return run_roadbed(more);
  }

  std::string own(const std::string& name) const {
    return (data_folder() / "scenarios" / name).string();
  }

  ProgramRun replay(const std::string& at, std::vector<std::string> more = {}) const {
    more.insert(more.begin(), {"plan", at, "-o", (folder_ / "plan").string(), "--force"});
    return run_roadbed(more);
  }
  std::string at(const std::string& t_s) const { return drive().string() + "@" + t_s; }
  fs::path drive() const { return folder_ / "drive"; }

  /// The cycle that stands in the log is what is planned again, and its plan the one of the log.
  void expect_replayed(const std::string& t_s, std::size_t cycle) const {
    const ProgramRun run = replay(at(t_s), {"--json"});
    ASSERT_LE(run.status, 1) << run.err;
    EXPECT_EQ(run.err, "");
    const json document = json::parse(run.out);
    const json logged = json::parse(lines_of(drive() / "cycles.jsonl").at(cycle));
    EXPECT_EQ(document["cycle"], logged) << t_s;
    EXPECT_EQ(run.status, logged["chosen"].is_null() ? 1 : 0);
    EXPECT_EQ(document["found"], !logged["chosen"].is_null());
    if (!logged["chosen"].is_null()) {
      for (const char* key : {"d_e_m", "l_e_m", "cost"}) {
        EXPECT_EQ(document["chosen"][key], logged["chosen"][key]) << t_s << " " << key;
      }
      const auto plan = tools::read_trajectory_csv(folder_ / "plan/trajectory.csv");
      EXPECT_EQ(plan.start_s(), logged["t_s"].get<double>());
    }
    const std::size_t candidates = lines_of(folder_ / "plan/candidates.csv").size() - 1;
    EXPECT_EQ(document["candidates"], candidates);
    EXPECT_GT(candidates, 100U);
    EXPECT_THAT(bytes_of(folder_ / "plan/plan.svg"), HasSubstr("</svg>"));
  }

  const TemporaryFolder folder_;
};

TEST_F(PlanReplay, IsTheCycleOfTheLogAtEveryTime) {
  for (const char* name : {"pass_car.json", "narrow_gap.json", "red_light.json", "overtake.json",
                           "lane_change.json"}) {
    simulate(own(name), {"--force"});
    const std::vector<std::string> cycles = lines_of(drive() / "cycles.jsonl");
    expect_replayed("0", 0);
    expect_replayed("4.2", 42);
    expect_replayed("4.29", 42);
    const auto rows = tools::read_trajectory_csv(drive() / "trajectory.csv");
    EXPECT_EQ(rows.points().size(), cycles.size() + 1);
    expect_replayed(std::to_string(rows.end_s()), cycles.size() - 1);
  }
}

// Its last row, at the end, is that of no cycle.
TEST_F(PlanReplay, AtTheEndOfADriveThatTimesOutIsTheLastCycle) {
  json scenario = json::parse(bytes_of(own("parked_car.json")));
  scenario["map"] = (data_folder() / "town.xodr").string();
  scenario["duration_s"] = 1.5;
  EXPECT_EQ(simulate(folder_.write("short.json", scenario.dump())).status, 1);
  EXPECT_EQ(lines_of(drive() / "cycles.jsonl").size(), 15U);
  expect_replayed("1.4", 14);
  expect_replayed("1.5", 14);
  EXPECT_THAT(replay(at("1.51")).err, HasSubstr("has no cycle at 1.51 s, needs 0 to 1.5 s"));
}

TEST_F(PlanReplay, ShowsACarThatIsPassedAsTheDriveWithCandidatesDid) {
  ASSERT_EQ(simulate(own("pass_car.json"), {"--candidates"}).status, 0);
  const std::vector<std::string> cycles = lines_of(drive() / "cycles.jsonl");
  const auto beside = std::ranges::find_if(cycles, [](const std::string& line) {
    return json::parse(line)["chosen"]["d_e_m"].get<double>() > 3.0;
  });
  ASSERT_NE(beside, cycles.end());
  const std::string t_s = json::parse(*beside)["t_s"].dump();
  const ProgramRun run = replay(at(t_s));
  EXPECT_EQ(run.status, 0) << run.err;
  EXPECT_THAT(run.out, HasSubstr("pass in the next lane, d_e +3."));
  EXPECT_THAT(run.out, HasSubstr(": driven\n"));
  EXPECT_THAT(run.out, HasSubstr("runner-up"));
}

TEST_F(PlanReplay, GivesTheSameBytesForAnyNumberOfThreads) {
  simulate(own("overtake.json"));
  std::vector<std::string> outs;
  for (const char* threads : {"1", "2"}) {
    const std::string out = (folder_ / threads).string();
    const ProgramRun run =
        run_roadbed({"plan", at("12"), "-o", out, "--json", "--threads", threads});
    EXPECT_EQ(run.status, 0) << run.err;
    outs.push_back(run.out);
  }
  EXPECT_EQ(outs[0], outs[1]);
  for (const char* file : {"candidates.csv", "trajectory.csv", "plan.svg"}) {
    EXPECT_EQ(bytes_of(folder_ / "1" / file), bytes_of(folder_ / "2" / file)) << file;
  }
}

TEST_F(PlanReplay, DrivesAsTheCommandLineAskedFor) {
  const std::string car = folder_.write("car.json", R"({"length_m": 5.1, "width_m": 1.9})");
  const std::string noise = folder_.write("noise.json", R"({"position_m": 0.05, "gap_m": 0.3})");
  const std::string how = folder_.write("how.json", R"({"style": "gentle"})");
  simulate(own("stop_and_go.json"),
           {"--vehicle", car, "--noise", noise, "--options", how, "--seed", "7", "--predict"});
  expect_replayed("10", 100);
  json record = json::parse(bytes_of(drive() / "replay.json"));
  record["seed"] = 8;
  std::filesystem::remove(drive() / "replay.json");
  folder_.write("drive/replay.json", record.dump());
  EXPECT_THAT(replay(at("10")).err, HasSubstr("drive/trajectory.csv:3: differs from the same"));
}

TEST_F(PlanReplay, OfARecordedProblemIsTheSame) {
  simulate((data_folder() / "junction.xml").string());
  expect_replayed("1.5", 15);
}

TEST_F(PlanReplay, OfRealRecordedProblemsIsTheSame) {
  ROADBED_REAL_DATA_OR_SKIP(real);
  const fs::path problems = real / "commonroad/CommonRoad+commonroad-reachable-set";
  for (const char* name : {"ZAM_Zip-1_6_T-1.xml", "ESP_Ceuta-5_1_T-1.xml"}) {
    simulate((problems / name).string(), {"--force"});
    expect_replayed("0", 0);
    expect_replayed("2.5", 25);
  }
}

TEST_F(PlanReplay, RefusesFilesThatHaveChangedByTheirNames) {
  const std::string map = folder_.write("town.xodr", bytes_of(data_folder() / "town.xodr"));
  std::string text = bytes_of(own("parked_car.json"));
  text.replace(text.find("../town.xodr"), 12, "town.xodr");
  const std::string scenario = folder_.write("scene.json", text);
  ASSERT_EQ(simulate(scenario).status, 0);
  ASSERT_EQ(replay(at("3")).status, 0);
  folder_.write("scene.json", text + " ");
  ProgramRun run = replay(at("3"));
  EXPECT_EQ(run.status, 3);
  EXPECT_THAT(run.err, HasSubstr("drive/../scene.json: has changed since the drive"));
  EXPECT_EQ(std::ranges::count(run.err, '\n'), 1);
  folder_.write("scene.json", text);
  fs::remove(map);
  EXPECT_THAT(replay(at("3")).err, HasSubstr("drive/../town.xodr: no such file"));
  folder_.write("town.xodr", "<OpenDRIVE/>");
  EXPECT_THAT(replay(at("3")).err, HasSubstr("drive/../town.xodr: has changed since the drive"));
}

TEST_F(PlanReplay, RefusesOthersWhoseRecordingsHaveChanged) {
  folder_.write("town.xodr", bytes_of(data_folder() / "town.xodr"));
  json scenario = json::parse(bytes_of(own("parked_car.json")));
  scenario["map"] = "town.xodr";
  ASSERT_EQ(simulate(folder_.write("alone.json", scenario.dump())).status, 0);
  const std::string rows = bytes_of(drive() / "trajectory.csv");
  folder_.write("before.csv", rows);
  // The same drive, 20 s later.
  scenario["obstacles"].push_back(
      {{"id", "behind"}, {"recorded", {{"file", "before.csv"}, {"offset_s", 20.0}}}});
  ASSERT_EQ(simulate(folder_.write("scene.json", scenario.dump()), {"--force"}).status, 0);
  ASSERT_EQ(replay(at("3")).status, 0);
  folder_.write("before.csv", rows.substr(0, rows.rfind('\n', rows.size() - 2) + 1));
  const ProgramRun run = replay(at("3"));
  EXPECT_EQ(run.status, 3);
  EXPECT_THAT(run.err, HasSubstr("drive/../before.csv: has changed since the drive"));
}

TEST_F(PlanReplay, RefusesADriveWhoseRowsOrCyclesAreNotThoseThatComeAgain) {
  ASSERT_EQ(simulate(own("parked_car.json")).status, 0);
  const auto with_other = [&](const char* name, std::size_t line, const std::string& time) {
    const std::string whole = bytes_of(drive() / name);
    std::size_t from = 0;
    for (std::size_t i = 1; i < line; ++i) from = whole.find('\n', from) + 1;
    std::string changed = whole;
    char& digit = changed[changed.find_first_of("123456789", from + 8)];
    digit = digit == '1' ? '2' : '1';
    folder_.write(std::string("drive/") + name, changed);
    const ProgramRun run = replay(at(time));
    folder_.write(std::string("drive/") + name, whole);
    return run;
  };
  for (const char* name : {"trajectory.csv", "cycles.jsonl"}) {
    const ProgramRun run = with_other(name, 12, "3");
    EXPECT_EQ(run.status, 3);
    EXPECT_THAT(run.err, HasSubstr(std::string("drive/") + name +
                                   ":12: differs from the same drive, driven again"));
    EXPECT_EQ(std::ranges::count(run.err, '\n'), 1);
    EXPECT_FALSE(fs::exists(folder_ / "plan"));
  }
  EXPECT_EQ(with_other("cycles.jsonl", 12, "0.5").status, 0) << "comes after that time";
  EXPECT_EQ(replay(at("3")).status, 0);
}

TEST_F(PlanReplay, RefusesRowsAfterTheEndOfTheDrive) {
  simulate(own("parked_car.json"));
  const std::string rows = bytes_of(drive() / "trajectory.csv");
  const std::size_t last = rows.rfind('\n', rows.size() - 2) + 1;
  const std::string more = "90" + rows.substr(rows.find(',', last));
  folder_.write("drive/trajectory.csv", rows + more + "91" + more.substr(2));
  const ProgramRun run = replay(at("80"));
  EXPECT_EQ(run.status, 3);
  EXPECT_THAT(run.err, HasSubstr("drive/trajectory.csv:"));
  EXPECT_THAT(run.err, HasSubstr(": differs from the same drive"));
}

TEST_F(PlanReplay, RefusesWhatIsNoTimeOfADrive) {
  simulate(own("parked_car.json"));
  const auto refused = [&](const std::string& scene, const char* message) {
    const ProgramRun run = replay(scene);
    EXPECT_EQ(run.status, 3);
    EXPECT_THAT(run.err, HasSubstr(message));
    EXPECT_EQ(std::ranges::count(run.err, '\n'), 1) << run.err;
    EXPECT_FALSE(fs::exists(folder_ / "plan"));
  };
  refused(at("1000"), "drive: has no cycle at 1000 s, needs 0 to ");
  refused(at("-0.1"), "drive: has no cycle at -0.1 s");
  refused(at("nan"), "\"nan\" is no time");
  refused(at("4 s"), "\"4 s\" is no time");
  refused(at(""), "\"\" is no time");
  refused((folder_ / "none").string() + "@1", "none: no such folder");
  refused(folder_.path().string() + "@1", ": holds no drive, needs a folder with a replay.json");
  std::string record = bytes_of(drive() / "replay.json");
  record.replace(record.find("\"roadbed_drive\": 1"), 18, "\"roadbed_drive\": 7");
  folder_.write("drive/replay.json", record);
  refused(at("1"), "replay.json:/roadbed_drive: is 7: another version of roadbed drove this");
}

TEST_F(PlanReplay, DoesNotGoWithOtherOptions) {
  simulate(own("parked_car.json"));
  for (const char* option : {"--options", "--circles"}) {
    EXPECT_EQ(replay(at("1"), {option, "4"}).status, 2) << option;
  }
}

TEST_F(PlanReplay, FollowsADriveThatIsMovedWithItsScenario) {
  fs::create_directories(folder_ / "here");
  fs::copy(data_folder() / "town.xodr", folder_ / "here/town.xodr");
  std::string text = bytes_of(own("parked_car.json"));
  text.replace(text.find("../town.xodr"), 12, "town.xodr");
  const std::string scenario = folder_.write("here/scene.json", text);
  run_roadbed({"simulate", scenario, "-o", (folder_ / "here/a@b").string()});
  fs::rename(folder_ / "here", folder_ / "there");
  EXPECT_EQ(replay((folder_ / "there/a@b").string() + "@2").status, 0);
  fs::rename(folder_ / "there/a@b", folder_ / "alone");
  EXPECT_THAT(replay((folder_ / "alone").string() + "@2").err,
              HasSubstr("alone/../scene.json: no such file"));
}

/// The lines below "Example:", without the program's name.
std::vector<std::vector<std::string>> examples_of(const std::string& command) {
  std::istringstream help(run_roadbed({command, "--help"}).out);
  std::vector<std::vector<std::string>> examples;
  for (std::string line; std::getline(help, line);) {
    std::istringstream words(line);
    std::string word;
    if (!(words >> word) || word != "roadbed") continue;
    examples.emplace_back();
    while (words >> word) examples.back().push_back(word);
  }
  return examples;
}

TEST_F(PlanReplay, IsWhatTheExampleOfTheHelpDoes) {
  ASSERT_EQ(simulate(own("pass_car.json")).status, 0);
  const auto examples = examples_of("plan");
  ASSERT_FALSE(examples.empty());
  std::vector<std::string> words = examples.back();
  ASSERT_EQ(words.at(1), "drive@4.2");
  words[1] = at("4.2");
  *(std::ranges::find(words, "-o") + 1) = (folder_ / "plan").string();
  const ProgramRun run = run_roadbed(words);
  EXPECT_EQ(run.status, 0) << run.err;
  EXPECT_THAT(run.out, testing::StartsWith("4.20 s, "));
}

}  // namespace
}  // namespace roadbed::tests
