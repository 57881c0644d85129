#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>

#include "roadbed/tests/support/program_run.h"
#include "roadbed/tests/support/real_data.h"
#include "roadbed/tools/files/trajectory_csv.h"

namespace roadbed::tests {
namespace {

using nlohmann::json;
using testing::ElementsAre;
using testing::HasSubstr;

class SimulateCommand : public testing::Test {
 protected:
  // 45 m along the town's first street.
  static json short_drive() {
    return {{"roadbed_scenario", 1},
            {"map", (data_folder() / "town.xodr").string()},
            {"ego", {{"start", "lane:1/3/1@6"}, {"speed_mps", 8.0}}},
            {"goal", "lane:1/3/1@45"},
            {"duration_s", 20.0}};
  }

  ProgramRun simulate(const json& scenario, const std::string& name, bool force = false) {
    const std::string file = folder_.write("scenario.json", scenario.dump());
    std::vector<std::string> arguments{"simulate", file, "-o", out(name).string()};
    if (force) arguments.push_back("--force");
    return run_roadbed(arguments);
  }

  std::filesystem::path out(const std::string& name) const { return folder_ / name; }

  const TemporaryFolder folder_;
};

TEST_F(SimulateCommand, ReachesTheGoalAndWritesTheSameBytesAgain) {
  const ProgramRun run = simulate(short_drive(), "a");
  ASSERT_EQ(run.status, 0) << run.err;
  EXPECT_THAT(run.out, HasSubstr("goal reached after"));
  EXPECT_THAT(files_below(out("a")), ElementsAre("cycles.jsonl", "drive.svg", "metrics.json",
                                                 "replay.json", "report.html", "trajectory.csv"));
  const json metrics = json::parse(bytes_of(out("a") / "metrics.json"));
  EXPECT_EQ(metrics["goal_reached"], true);
  EXPECT_EQ(metrics["largest_off_road_m"], 0.0);
  EXPECT_EQ(tools::read_trajectory_csv(out("a") / "trajectory.csv").start_s(), 0.0);

  ASSERT_EQ(simulate(short_drive(), "b").status, 0);
  for (const std::string& file : files_below(out("a"))) {
    EXPECT_EQ(bytes_of(out("a") / file), bytes_of(out("b") / file)) << file;
  }
}

TEST_F(SimulateCommand, AGoalThatIsNotReachedIsStatusOneWithItsOutputs) {
  json scenario = short_drive();
  scenario["duration_s"] = 1.0;
  const ProgramRun run = simulate(scenario, "a");
  EXPECT_EQ(run.status, 1);
  EXPECT_THAT(run.out, HasSubstr("before the goal"));
  EXPECT_EQ(files_below(out("a")).size(), 6U);
}

TEST_F(SimulateCommand, OutputsAreOnlyReplacedWithForce) {
  json scenario = short_drive();
  scenario["duration_s"] = 0.2;
  simulate(scenario, "a");
  const std::string before = bytes_of(out("a") / "metrics.json");
  scenario["seed"] = 2;
  EXPECT_EQ(simulate(scenario, "a").status, 3);
  EXPECT_EQ(bytes_of(out("a") / "metrics.json"), before);
  simulate(scenario, "a", true);
  EXPECT_NE(bytes_of(out("a") / "metrics.json"), before);
}

TEST_F(SimulateCommand, UnusableInputLeavesNothingBehind) {
  const auto refused = [&](const char* pointer, const json& value, const char* message) {
    json scenario = short_drive();
    scenario[json::json_pointer(pointer)] = value;
    const ProgramRun run = simulate(scenario, "a");
    EXPECT_EQ(run.status, 3);
    EXPECT_THAT(run.err, HasSubstr(message));
    EXPECT_EQ(run.out, "");
    EXPECT_FALSE(std::filesystem::exists(out("a"))) << message;
  };
  refused("/goal", "lane:1/3/1@4500", "scenario.json:/goal: place");
  refused("/goal", "1e6,1e6", "off the road");
  refused("/ego/start", "nowhere", "scenario.json:/ego/start: place");
  refused("/map", "missing.xodr", "no such file");
  refused("/occupancy", "missing.bt", "no such file");
  refused("/duration_s", -1, "scenario.json:/duration_s: is -1");
  const json inside = {{"id", "a"}, {"parked", {{"place", "lane:1/3/1@7"}}}};
  refused("/obstacles", json::array({inside}), "scenario.json:/obstacles/0: a touches the ego");
}

TEST_F(SimulateCommand, FolderDrivesEveryScenarioAndABadOneIsARow) {
  json late = short_drive();
  late["duration_s"] = 0.5;
  const TemporaryFolder scenarios;
  scenarios.write("good.json", short_drive().dump());
  scenarios.write("late.json", late.dump());
  scenarios.write("bad.json", "{}");
  const ProgramRun one = run_roadbed({"simulate", scenarios.path().string(), "-o", out("one")});
  const ProgramRun two =
      run_roadbed({"simulate", scenarios.path().string(), "-o", out("two"), "--threads", "2"});
  EXPECT_EQ(one.status, 1);
  EXPECT_EQ(one.out, two.out);
  EXPECT_THAT(one.out, HasSubstr("\n1 of 3 reach their goal\n"));
  const std::vector<std::string> files = files_below(out("one"));
  EXPECT_EQ(files.size(), 13U);
  EXPECT_EQ(files, files_below(out("two")));
  for (const std::string& file : files) {
    EXPECT_EQ(bytes_of(out("one") / file), bytes_of(out("two") / file)) << file;
  }
  scenarios.write("good.xml", "<commonRoad/>");
  const ProgramRun same = run_roadbed({"simulate", scenarios.path().string(), "-o", out("same")});
  EXPECT_EQ(same.status, 3);
  EXPECT_THAT(same.err, HasSubstr("two scenarios of the name good"));
  EXPECT_FALSE(std::filesystem::exists(out("same")));
}

TEST_F(SimulateCommand, FolderMayHoldCommonRoadFilesAndOtherXml) {
  const TemporaryFolder scenarios;
  scenarios.write("junction.xml", bytes_of(data_folder() / "junction.xml"));
  scenarios.write("other.xml", "<OpenDRIVE/>");
  for (const std::string out_folder : {"one", "two"}) {
    const ProgramRun run =
        run_roadbed({"simulate", scenarios.path().string(), "-o", out(out_folder), "--predict"});
    EXPECT_EQ(run.status, 1) << run.err;
    EXPECT_THAT(run.out, HasSubstr("goal reached"));
    EXPECT_THAT(run.out, HasSubstr("no <commonRoad> element"));
    EXPECT_THAT(run.out, HasSubstr("\n1 of 2 reach their goal\n"));
    EXPECT_TRUE(std::filesystem::exists(out(out_folder) / "junction" / "solution.xml"));
    EXPECT_FALSE(std::filesystem::exists(out(out_folder) / "other"));
  }
  for (const std::string& file : files_below(out("one"))) {
    EXPECT_EQ(bytes_of(out("one") / file), bytes_of(out("two") / file)) << file;
  }
}

TEST_F(SimulateCommand, AVehicleFileIsWhatTheSameKeysInTheScenarioAre) {
  const std::string lorry = R"({"length_m": 8.0, "width_m": 2.4, "wheelbase_m": 4.5})";
  json otherwise = short_drive();
  otherwise["obstacles"] = {{{"id", "a"}, {"parked", {{"place", "lane:1/3/1@30"}, {"d_m", -4.0}}}}};
  json inside = otherwise;
  inside["vehicle"] = json::parse(lorry);
  ASSERT_EQ(simulate(inside, "inside").status, 0);
  ASSERT_EQ(simulate(otherwise, "otherwise").status, 0);
  const std::string file = folder_.write("lorry.json", lorry);
  const ProgramRun run = run_roadbed({"simulate", (folder_ / "scenario.json").string(), "--vehicle",
                                      file, "-o", out("given").string()});
  ASSERT_EQ(run.status, 0) << run.err;
  for (const char* name : {"trajectory.csv", "metrics.json"}) {
    EXPECT_EQ(bytes_of(out("given") / name), bytes_of(out("inside") / name)) << name;
  }
  EXPECT_NE(bytes_of(out("given") / "metrics.json"), bytes_of(out("otherwise") / "metrics.json"));
  EXPECT_THAT(bytes_of(out("given") / "report.html"), HasSubstr("--vehicle lorry.json"));
}

TEST_F(SimulateCommand, ASeedIsWhatItIsInTheScenarioAndAnotherOneGivesAnotherDrive) {
  json scenario = short_drive();
  scenario["noise"] = {{"position_m", 0.05}};
  scenario["seed"] = 5;
  ASSERT_EQ(simulate(scenario, "inside").status, 0);
  scenario.erase("seed");
  for (const char* seed : {"5", "6"}) {
    const std::string file = folder_.write("scenario.json", scenario.dump());
    ASSERT_EQ(run_roadbed({"simulate", file, "--seed", seed, "-o", out(seed).string()}).status, 0);
  }
  for (const char* name : {"trajectory.csv", "metrics.json"}) {
    EXPECT_EQ(bytes_of(out("5") / name), bytes_of(out("inside") / name)) << name;
    EXPECT_NE(bytes_of(out("6") / name), bytes_of(out("inside") / name)) << name;
  }
}

TEST_F(SimulateCommand, CommonRoadTakesNoiseBySeedAndAnotherVehicle) {
  const std::string file = (data_folder() / "junction.xml").string();
  const std::string noise = folder_.write("noise.json", R"({"position_m": 0.02})");
  const auto drive = [&](const std::string& name, std::vector<std::string> more) {
    more.insert(more.begin(), {"simulate", file, "-o", out(name).string()});
    const ProgramRun run = run_roadbed(more);
    EXPECT_EQ(run.err.find("roadbed:"), std::string::npos) << run.err;
    return bytes_of(out(name) / "trajectory.csv");
  };
  const std::string one = drive("one", {"--noise", noise, "--seed", "1"});
  EXPECT_EQ(drive("again", {"--noise", noise, "--seed", "1"}), one);
  EXPECT_NE(drive("two", {"--noise", noise, "--seed", "2"}), one);
  EXPECT_TRUE(std::filesystem::exists(out("one") / "solution.xml"));
  const std::string small = folder_.write("small.json", R"({"length_m": 3.6})");
  EXPECT_NE(drive("small", {"--vehicle", small}), drive("plain", {}));
  EXPECT_FALSE(std::filesystem::exists(out("small") / "solution.xml"));
  EXPECT_NE(drive("one", {"--vehicle", small, "--force"}), one);
  EXPECT_FALSE(std::filesystem::exists(out("one") / "solution.xml")) << "that of the first drive";
}

TEST_F(SimulateCommand, RefusesChangesThatCannotBeMade) {
  const std::string scenario = folder_.write("scenario.json", short_drive().dump());
  const auto refused = [&](const std::string& option, const std::string& value, int status) {
    const ProgramRun run =
        run_roadbed({"simulate", scenario, option, value, "-o", out("a").string()});
    EXPECT_EQ(run.status, status) << value;
    EXPECT_FALSE(std::filesystem::exists(out("a"))) << value;
    return run.err;
  };
  EXPECT_THAT(refused("--seed", "7", 3), HasSubstr("leave --seed out, or give --noise"));
  for (const char* text : {"1.5", "-1", "many", "9007199254740993"}) {
    EXPECT_THAT(refused("--seed", text, 2), HasSubstr("is no whole number")) << text;
  }
  const std::string truck = folder_.write("truck.json", R"({"length_mm": 8000})");
  EXPECT_THAT(refused("--vehicle", truck, 3), HasSubstr("truck.json:/length_mm"));
  const std::string mirrors =
      folder_.write("mirrors.json", R"({"mirrors": {"beyond_m": 0.2, "rear_m": 1.7, "front_m": 1.9,
                                      "from_height_m": 0.9, "to_height_m": 1.2}})");
  EXPECT_THAT(refused("--vehicle", mirrors, 3), HasSubstr("which only audits look at"));
  EXPECT_THAT(refused("--vehicle", (folder_ / "none.json").string(), 3), HasSubstr("no such file"));
  const std::string noise = folder_.write("noise.json", R"({"position_m": -1})");
  EXPECT_THAT(refused("--noise", noise, 3), HasSubstr("noise.json:/position_m"));
}

TEST_F(SimulateCommand, ControlDesignPrintsOneJsonDocument) {
  const ProgramRun run = run_roadbed({"control", "design", "--json"});
  EXPECT_EQ(run.status, 0);
  const json design = json::parse(run.out);
  EXPECT_NEAR(design["K"][0].get<double>(), 0.9114729761, 1e-9);
  EXPECT_LT(design["riccati_residual"].get<double>(), 1e-12);
  EXPECT_EQ(run_roadbed({"control", "design", "--input-weight", "-1"}).status, 2);
  EXPECT_EQ(run_roadbed({"control"}).status, 2);
}

}  // namespace
}  // namespace roadbed::tests
