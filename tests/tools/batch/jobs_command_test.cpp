#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <sstream>
#include <string>
#include <vector>

#include "roadbed/tests/support/program_run.h"

namespace roadbed::tests {
namespace {

using nlohmann::json;
using testing::HasSubstr;

std::vector<json> jobs_written(const std::string& file) {
  std::istringstream text(bytes_of(file));
  std::vector<json> jobs;
  for (std::string line; std::getline(text, line);) jobs.push_back(json::parse(line));
  return jobs;
}

TEST(JobsCommand, WritesAJobForEachFileBelowAFolderSorted) {
  const TemporaryFolder folder;
  std::filesystem::create_directories(folder / "maps/b/c");
  for (const char* name :
       {"maps/z.xodr", "maps/a.osm", "maps/b/y.xodr", "maps/b/c/x.xodr", "maps/b/.hidden.xodr"}) {
    folder.write(name, "");
  }
  const std::string out = (folder / "jobs.jsonl").string();
  const ProgramRun run =
      run_roadbed({"jobs", "import", (folder / "maps/**/*.xodr").string(), "-o", out});
  ASSERT_EQ(run.status, 0) << run.err;
  std::vector<std::string> inputs;
  for (const json& job : jobs_written(out)) inputs.push_back(job["inputs"][0]);
  EXPECT_EQ(inputs, (std::vector<std::string>{(folder / "maps/b/c/x.xodr").string(),
                                              (folder / "maps/b/y.xodr").string(),
                                              (folder / "maps/z.xodr").string()}));
}

TEST(JobsCommand, WritesTheProductOfAllLists) {
  const TemporaryFolder folder;
  for (const char* name : {"a.csv", "b.csv", "one.bt"}) folder.write(name, "");
  const std::string out = (folder / "jobs.jsonl").string();
  const ProgramRun run =
      run_roadbed({"jobs", "audit", "--occupancy", (folder / "*.bt").string(), "--trajectory",
                   (folder / "?.csv").string(), "--inflate", "1..3", "--clearance", "0.5",
                   "--outputs", "report,certificate", "-o", out});
  ASSERT_EQ(run.status, 0) << run.err;
  const auto jobs = jobs_written(out);
  ASSERT_EQ(jobs.size(), 6U);
  for (std::size_t i = 0; i < jobs.size(); ++i) {
    const json& options = jobs[i]["options"];
    EXPECT_EQ(options["trajectory"], (folder / (i < 3 ? "a.csv" : "b.csv")).string());
    EXPECT_EQ(options["inflate"], i % 3 + 1);
    EXPECT_EQ(options["clearance"], "0.5");
    EXPECT_EQ(jobs[i]["outputs"], json({"report", "certificate"}));
  }
}

TEST(JobsCommand, MultipliesScenariosByVehiclesAndSeeds) {
  const TemporaryFolder folder;
  for (const char* name : {"a.json", "b.json", "car_1.json", "car_2.json"}) folder.write(name, "");
  const std::string out = (folder / "jobs.jsonl").string();
  const ProgramRun run =
      run_roadbed({"jobs", "simulate", (folder / "?.json").string(), "--vehicle",
                   (folder / "car_*.json").string(), "--seed", "0..9", "20", "-o", out});
  ASSERT_EQ(run.status, 0) << run.err;
  const auto jobs = jobs_written(out);
  ASSERT_EQ(jobs.size(), 2U * 2U * 11U);
  for (std::size_t i = 0; i < jobs.size(); ++i) {
    EXPECT_EQ(jobs[i]["inputs"][0], (folder / (i < 22 ? "a.json" : "b.json")).string());
    const json& options = jobs[i]["options"];
    EXPECT_EQ(options["vehicle"], (folder / (i % 22 < 11 ? "car_1.json" : "car_2.json")).string());
    EXPECT_EQ(options["seed"], i % 11 < 10 ? json(i % 11) : json("20"));
  }
}

TEST(JobsCommand, WritesARouteForEachPair) {
  const TemporaryFolder folder;
  const std::string pairs = folder.write("od.csv", "from,to\n\"1,2\",\"3,4\"\nlane:a,lane:b\n");
  const std::string out = (folder / "jobs.jsonl").string();
  const ProgramRun run =
      run_roadbed({"jobs", "route", folder.write("town.rbm", ""), "--pairs", pairs, "-o", out});
  ASSERT_EQ(run.status, 0) << run.err;
  const auto jobs = jobs_written(out);
  ASSERT_EQ(jobs.size(), 2U);
  EXPECT_EQ(jobs[0]["options"], json({{"from", "1,2"}, {"to", "3,4"}}));
  EXPECT_EQ(jobs[1]["options"], json({{"from", "lane:a"}, {"to", "lane:b"}}));
}

TEST(JobsCommand, RefusesAPatternThatMatchesNothingAndAnUnknownOutput) {
  const TemporaryFolder folder;
  const std::string out = (folder / "jobs.jsonl").string();
  const ProgramRun none = run_roadbed({"jobs", "import", (folder / "*.xodr").string(), "-o", out});
  EXPECT_EQ(none.status, 3);
  EXPECT_THAT(none.err, HasSubstr("matches no file"));
  const ProgramRun unknown =
      run_roadbed({"jobs", "validate", folder.write("a.xodr", ""), "--outputs", "pdf", "-o", out});
  EXPECT_EQ(unknown.status, 3);
  EXPECT_FALSE(std::filesystem::exists(out));
  EXPECT_EQ(run_roadbed({"jobs", "import", "--spped", "1", "-o", out}).status, 2);
}

TEST(JobsCommand, RefusesWhatTheCommandItselfWouldNotTake) {
  const TemporaryFolder folder;
  const std::string out = (folder / "jobs.jsonl").string();
  const std::string scenario = folder.write("a.json", "");
  const auto refusal = [&](std::vector<std::string> words) {
    words.insert(words.begin(), "jobs");
    words.insert(words.end(), {"-o", out});
    const ProgramRun run = run_roadbed(words);
    EXPECT_EQ(run.status, 3);
    EXPECT_FALSE(std::filesystem::exists(out));
    return run.err;
  };
  EXPECT_THAT(refusal({"simulate", scenario, "--seed", "1", "2,3"}),
              HasSubstr("--seed: is no whole number"));
  EXPECT_THAT(refusal({"route", scenario}), HasSubstr("--from and --to are required"));
  EXPECT_THAT(refusal({"audit", "--occupancy", scenario}), HasSubstr("roadbed audit --help"));
}

TEST(JobsCommand, RefusesMoreJobsThanAFileShouldHold) {
  const TemporaryFolder folder;
  const std::string out = (folder / "jobs.jsonl").string();
  for (const char* range : {"1..100000", "1..900000000000"}) {
    const ProgramRun run = run_roadbed({"jobs", "audit", "--occupancy", folder.write("a.bt", ""),
                                        "--inflate", range, "--clearance", "1..100000", "-o", out});
    EXPECT_EQ(run.status, 3);
    EXPECT_THAT(run.err, HasSubstr("write several files of jobs"));
  }
  EXPECT_FALSE(std::filesystem::exists(out));
}

TEST(JobsCommand, RefusesANameThatJsonCannotHold) {
  const TemporaryFolder folder;
  const std::string out = (folder / "jobs.jsonl").string();
  const ProgramRun run = run_roadbed({"jobs", "import",
                                      folder.write("stra\xdf"
                                                   "e.xodr",
                                                   ""),
                                      "-o", out});
  EXPECT_EQ(run.status, 3);
  EXPECT_THAT(run.err, HasSubstr("no UTF-8"));
  EXPECT_FALSE(std::filesystem::exists(out));
}

}  // namespace
}  // namespace roadbed::tests
