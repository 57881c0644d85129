// `plan` as a user runs it.
#include <gtest/gtest.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>

#include "roadbed/tests/support/program_run.h"
#include "roadbed/tests/support/real_data.h"
#include "roadbed/tools/files/trajectory_csv.h"

namespace roadbed::tests {
namespace {

std::string scene(const std::string& name) { return (data_folder() / "scenarios" / name).string(); }

TEST(PlanCommand, PassesALorryAndShowsEveryCandidate) {
  const TemporaryFolder folder;
  const std::string out = (folder / "plan").string();
  const ProgramRun run = run_roadbed({"plan", scene("pass_lorry.json"), "-o", out, "--json"});
  ASSERT_EQ(run.status, 0) << run.err;
  const auto document = nlohmann::json::parse(run.out);
  EXPECT_TRUE(document["found"]);
  EXPECT_EQ(document["candidates"], 5396);
  EXPECT_GT(document["chosen"]["d_e_m"], 1.5);
  EXPECT_GT(document["rejected"]["collision"], 500);
  EXPECT_EQ(document["chosen"]["terms"].size(), 12u);
  EXPECT_EQ(files_below(out),
            (std::vector<std::string>{"candidates.csv", "plan.svg", "trajectory.csv"}));
  const std::string csv = bytes_of(folder / "plan/candidates.csv");
  EXPECT_EQ(std::count(csv.begin(), csv.end(), '\n'), 5397);
  EXPECT_GT(tools::read_trajectory_csv(folder / "plan/trajectory.csv").points().size(), 30u);
}

TEST(PlanCommand, ExplainsTheSharesOfTheChosenAndTheRunnerUp) {
  const TemporaryFolder folder;
  const ProgramRun run = run_roadbed({"plan", scene("pass_lorry.json"), "-o",
                                      (folder / "plan").string(), "--explain", "--circles", "4"});
  ASSERT_EQ(run.status, 0) << run.err;
  double chosen = 0.0, second = 0.0;
  std::istringstream lines(run.out);
  for (std::string line; std::getline(lines, line);) {
    if (line.size() < 2 || line.substr(line.size() - 2) != " %") continue;
    std::istringstream words(line);
    std::string name, percent;
    double weight = 0.0, cost = 0.0, fraction = 0.0;
    words >> name >> weight >> cost >> fraction >> percent;
    chosen += fraction;
    words >> cost >> fraction;
    second += fraction;
  }
  EXPECT_NEAR(chosen, 100.0, 0.7);
  EXPECT_NEAR(second, 100.0, 0.7);
  EXPECT_NE(run.out.find("runner-up: d_e"), std::string::npos) << run.out;
  EXPECT_NE(run.out.find("4 circles"), std::string::npos) << run.out;
}

TEST(PlanCommand, WeightsFromAFileChangeTheChoice) {
  const TemporaryFolder folder;
  const std::string weights = folder.write("w.json", R"({"weights": {"length": 0, "time": 5}})");
  const auto length_with = [&](const std::vector<std::string>& more) {
    std::vector<std::string> arguments = {
        "plan", scene("parked_car.json"), "-o", (folder / "plan").string(), "--force", "--json"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    const ProgramRun run = run_roadbed(arguments);
    EXPECT_EQ(run.status, 0) << run.err;
    return nlohmann::json::parse(run.out)["chosen"]["l_e_m"].get<double>();
  };
  EXPECT_GT(length_with({}), 20.0);
  EXPECT_NEAR(length_with({"--options", weights}), 15.0, 1e-9);
}

TEST(PlanCommand, RefusesAnUnknownWeightAndWritesNothing) {
  const TemporaryFolder folder;
  const std::string weights = folder.write("w.json", R"({"weights": {"ofset": 1}})");
  const ProgramRun run = run_roadbed(
      {"plan", scene("parked_car.json"), "-o", (folder / "plan").string(), "--options", weights});
  EXPECT_EQ(run.status, 3);
  EXPECT_NE(run.err.find("w.json:/weights/ofset"), std::string::npos) << run.err;
  EXPECT_EQ(run.out, "");
  EXPECT_EQ(files_below(folder.path()), (std::vector<std::string>{"w.json"}));
}

TEST(PlanCommand, SaysNoWithAReasonAndKeepsTheCandidates) {
  const TemporaryFolder folder;
  std::string blocked = bytes_of(scene("pass_lorry.json"));
  const std::string left_lane = "lane:31/0/-1@10";
  blocked.replace(blocked.find("../town.xodr"), 12, (data_folder() / "town.xodr").string());
  blocked.replace(blocked.find(left_lane), left_lane.size(), "lane:31/0/-1@42");
  blocked.replace(blocked.find("\"speed_mps\": 11.0"), 17, "\"speed_mps\": 4.00");
  const ProgramRun run = run_roadbed(
      {"plan", folder.write("blocked.json", blocked), "-o", (folder / "plan").string()});
  EXPECT_EQ(run.status, 1);
  EXPECT_NE(run.out.find("no plan: none of 5396 candidates"), std::string::npos) << run.out;
  EXPECT_EQ(files_below(folder / "plan"), (std::vector<std::string>{"candidates.csv", "plan.svg"}));
}

TEST(PlanCommand, WritesTheSameBytesTwice) {
  const TemporaryFolder folder;
  for (const char* name : {"a", "b"}) {
    ASSERT_EQ(
        run_roadbed({"plan", scene("pass_lorry.json"), "-o", (folder / name).string()}).status, 0);
  }
  for (const char* file : {"candidates.csv", "trajectory.csv", "plan.svg"}) {
    EXPECT_EQ(bytes_of(folder / "a" / file), bytes_of(folder / "b" / file)) << file;
  }
}

}  // namespace
}  // namespace roadbed::tests
