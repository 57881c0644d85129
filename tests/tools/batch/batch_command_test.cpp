// `batch` as a user runs it, on the project's own town.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <functional>
#include <map>
#include <nlohmann/json.hpp>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include "roadbed/tests/support/sha256sum.h"
#include "roadbed/tests/tools/batch/batch_runs.h"

namespace roadbed::tests {
namespace {

using testing::HasSubstr;
using testing::Not;

TEST(BatchCommand, GivesEveryJobTheResultOfTheCommandAlone) {
  const TemporaryFolder inputs, folder, alone;
  const std::string jobs = inputs.write("jobs.jsonl", jobs_of_all_kinds(inputs));
  const ProgramRun run = batch(jobs, folder.path());
  EXPECT_EQ(run.status, 1) << run.err;
  EXPECT_THAT(run.out, HasSubstr("13 jobs: "));
  const auto results = results_in(folder.path());
  ASSERT_EQ(results.size(), 13U);
  for (int i = 0; i < 6; ++i) {
    const std::string name = "drive_" + std::to_string(i);
    const std::string proof = (alone / (name + ".json")).string();
    const std::string page = (alone / (name + ".html")).string();
    const ProgramRun command =
        run_roadbed({"audit", "--occupancy", wall_in(inputs), "--trajectory",
                     (inputs / (name + ".csv")).string(), "--unknown", "free", "--certificate",
                     proof, "--report", page, "--json"});
    const json& result = results[static_cast<std::size_t>(i)];
    EXPECT_EQ(result["exit"], command.status);
    EXPECT_EQ(result["status"], command.status == 0 ? "done" : "no");
    EXPECT_EQ(result["result"], json::parse(command.out));
    ASSERT_EQ(result["files"].size(), 2U);
    EXPECT_EQ(bytes_of(folder / result["files"][0].get<std::string>()), bytes_of(proof));
    EXPECT_EQ(bytes_of(folder / result["files"][1].get<std::string>()), bytes_of(page));
  }
  EXPECT_EQ(results[6]["result"], results[11]["result"]);
  EXPECT_EQ(results[10]["status"], "failed");
  EXPECT_THAT(results[10]["reason"].get<std::string>(), HasSubstr("no such file"));
  EXPECT_EQ(results[12]["line"], 13);
  EXPECT_EQ(results[12]["cause"], "line");
}

TEST(BatchCommand, WritesTheSameBytesForAnyNumberOfThreadsAndIsolated) {
  const TemporaryFolder inputs, one, two, four, isolated;
  const std::string jobs = inputs.write("jobs.jsonl", jobs_of_all_kinds(inputs));
  batch(jobs, one.path());
  batch(jobs, two.path(), {"--threads", "2"});
  batch(jobs, four.path(), {"--threads", "4", "--memory", "1MB"});
  batch(jobs, isolated.path(), {"--threads", "2", "--isolate", "--time-limit", "500"});
  const auto expected = outputs_of_batch(one.path());
  EXPECT_GT(expected.size(), 15U);
  EXPECT_TRUE(outputs_of_batch(two.path()) == expected);
  EXPECT_TRUE(outputs_of_batch(four.path()) == expected);
  EXPECT_TRUE(outputs_of_batch(isolated.path()) == expected);
}

TEST(BatchCommand, DrivesEachScenarioWithEachVehicleAndSeed) {
  const TemporaryFolder inputs, folder;
  const std::string scenario = (data_folder() / "scenarios/stop_and_go.json").string();
  for (const char* length : {"4.0", "4.6"}) {
    inputs.write(std::string("car_") + length + ".json",
                 std::string(R"({"length_m": )") + length + "}");
  }
  const std::string jobs = (inputs / "jobs.jsonl").string();
  ASSERT_EQ(run_roadbed({"jobs", "simulate", scenario, "--vehicle",
                         (inputs / "car_*.json").string(), "--seed", "3..4", "-o", jobs})
                .status,
            0);
  EXPECT_EQ(batch(jobs, folder.path(), {"--threads", "2"}).status, 0);
  const auto results = results_in(folder.path());
  ASSERT_EQ(results.size(), 4U);
  std::set<std::string> drives;
  for (std::size_t i = 0; i < results.size(); ++i) {
    EXPECT_EQ(results[i]["result"]["seed"], i % 2 + 3);
    for (const auto& file : results[i]["files"]) {
      const auto name = file.get<std::string>();
      if (name.ends_with("trajectory.csv")) drives.insert(bytes_of(folder / name));
    }
  }
  EXPECT_EQ(drives.size(), 4U);
  inputs.write("car_4.6.json", R"({"length_m": 4.7})");
  EXPECT_THAT(batch(jobs, folder.path()).out, HasSubstr("2 were there already"));
}

TEST(BatchCommand, GivesDrivesThatShareMapAndOccupancyWhatTheCommandAloneDoes) {
  const TemporaryFolder inputs, folder, alone;
  const std::string scenario = (data_folder() / "drive.json").string();
  const std::string cars[] = {inputs.write("low.json", R"({"height_m": 1.2})"),
                              inputs.write("high.json", R"({"height_m": 2.4, "width_m": 1.8})")};
  std::string lines;
  for (const std::string& car : cars) {
    lines += json({{"job", "simulate"}, {"inputs", {scenario}}, {"options", {{"vehicle", car}}}})
                 .dump() +
             "\n";
  }
  batch(inputs.write("jobs.jsonl", lines), folder.path(), {"--threads", "2"});
  const auto results = results_in(folder.path());
  ASSERT_EQ(results.size(), 2U);
  for (std::size_t i = 0; i < 2; ++i) {
    const std::string out = (alone / std::to_string(i)).string();
    run_roadbed({"simulate", scenario, "--vehicle", cars[i], "-o", out});
    ASSERT_EQ(results[i]["files"].size(), 6U);
    for (const auto& file : results[i]["files"]) {
      const std::filesystem::path name = file.get<std::string>();
      if (name.filename() == "replay.json") {  // says where its files are, seen from its folder
        const std::string drive = (folder / name.parent_path().string()).string();
        EXPECT_EQ(run_roadbed({"plan", drive + "@3", "-o", out + "_plan"}).status, 0);
        continue;
      }
      EXPECT_TRUE(bytes_of(folder / name.string()) ==
                  bytes_of(std::filesystem::path(out) / name.filename()))
          << name;
    }
  }
}

TEST(BatchCommand, RunsAgainOnlyWhatChanged) {
  const TemporaryFolder inputs, folder;
  const std::string jobs = inputs.write("jobs.jsonl", jobs_of_all_kinds(inputs));
  batch(jobs, folder.path());
  const auto first = outputs_of_batch(folder.path());
  const std::size_t runs = lines_below(folder / "journal");
  const ProgramRun again = batch(jobs, folder.path());
  EXPECT_THAT(again.out, HasSubstr("13 were there already"));
  EXPECT_EQ(lines_below(folder / "journal"), runs);
  EXPECT_TRUE(outputs_of_batch(folder.path()) == first);
  inputs.write("drive_3.csv", drive_csv(-5.0));
  EXPECT_THAT(batch(jobs, folder.path()).out, HasSubstr("12 were there already"));
  EXPECT_EQ(lines_below(folder / "journal"), runs + 1);
}

TEST(BatchCommand, RunsAgainWhereAFileThatWordsNameHasChanged) {
  const TemporaryFolder inputs, folder;
  const auto area = [](const char* edge_y_m) {
    return std::string(
               R"({"type":"Polygon","crs":null,"coordinates":[[[100,190],[200,190],[200,)") +
           edge_y_m + "],[100," + edge_y_m + "],[100,190]]]}";
  };
  const std::string file = inputs.write("area.geojson", area("210"));
  const json job = {
      {"job", "audit"},
      {"options",
       {{"on", "area:" + file}, {"trajectory", inputs.write("drive.csv", drive_csv(0.0))}}}};
  const std::string jobs = inputs.write("jobs.jsonl", job.dump() + "\n");
  batch(jobs, folder.path());
  EXPECT_EQ(results_in(folder.path()).front()["exit"], 0);
  EXPECT_THAT(batch(jobs, folder.path()).out, HasSubstr("1 were there already"));
  inputs.write("area.geojson", area("198"));  // the drive's middle line
  batch(jobs, folder.path());
  EXPECT_EQ(results_in(folder.path()).front()["exit"], 1);
}

TEST(BatchCommand, RunsAgainAJobOneOfWhoseFilesIsGone) {
  const TemporaryFolder inputs, folder;
  const std::string jobs = inputs.write("jobs.jsonl", audit_jobs(inputs, 13));
  batch(jobs, folder.path());
  const auto first = outputs_of_batch(folder.path());
  std::filesystem::remove(folder / results_in(folder.path())[2]["files"][0].get<std::string>());
  EXPECT_THAT(batch(jobs, folder.path()).out, HasSubstr("12 were there already"));
  EXPECT_TRUE(outputs_of_batch(folder.path()) == first);
}

TEST(BatchCommand, RunsAgainAJobOneOfWhoseFilesIsNotAsItWas) {
  const TemporaryFolder inputs, folder;
  const std::string jobs = inputs.write("jobs.jsonl", audit_jobs(inputs, 5));
  batch(jobs, folder.path());
  const auto first = outputs_of_batch(folder.path());
  const std::string file = results_in(folder.path())[2]["files"][1];
  std::string bytes = bytes_of(folder / file);
  bytes[bytes.size() / 2] ^= 1;
  folder.write(file, bytes);
  EXPECT_EQ(batch(jobs, folder.path(), {"--merge"}).status, 3);
  EXPECT_THAT(batch(jobs, folder.path()).out, HasSubstr("4 were there already"));
  EXPECT_TRUE(outputs_of_batch(folder.path()) == first);
}

// The folder's journal, with one of its lines in place of what it was.
void tamper(const TemporaryFolder& folder, std::size_t which,
            const std::function<void(json&)>& change) {
  std::istringstream journal(bytes_of(folder / "journal/000001.jsonl"));
  std::string lines;
  for (std::string line; std::getline(journal, line);) {
    if (which-- == 0) {
      json result = json::parse(line);
      change(result);
      line = result.dump();
    }
    lines += line + "\n";
  }
  folder.write("journal/000001.jsonl", lines);
}

TEST(BatchCommand, RunsAgainOnlyTheJobWhoseLineWasTamperedWith) {
  const TemporaryFolder inputs, calm;
  const std::string jobs = inputs.write("jobs.jsonl", audit_jobs(inputs, 4));
  batch(jobs, calm.path());
  const auto first = outputs_of_batch(calm.path());
  const std::string other = results_in(calm.path())[3]["hash"];
  const std::vector<std::function<void(json&)>> changes = {
      [](json& line) { line["job"] = "tea"; },
      [](json& line) { line["job"] = 7; },
      [](json& line) { line["job"] = "route"; },
      [](json& line) {
        line["inputs"] = {{"a", 1}};
      },
      [](json& line) {
        line["inputs"] = {1, 2};
      },
      [](json& line) { line["options"] = "none"; },
      [](json& line) { line.erase("options"); },
      [](json& line) { line["options"]["inflate"] = 5; },
      [](json& line) { line["outputs"] = 3; },
      [](json& line) { line["status"] = "great"; },
      [](json& line) { line["cause"] = "weather"; },
      [](json& line) {
        line["files"] = {{"a", 1}};
      },
      [](json& line) {
        line["files"] = {"/etc/passwd", "/etc/passwd"};
      },
      [](json& line) {
        line["files"] = {"../../x", ""};
      },
      [](json& line) { line["files"][0] = "journal"; },
      [](json& line) { line["sha256"][0] = std::string(64, '0'); },
      [](json& line) { line.erase("sha256"); },
      [](json& line) { line.erase("hash"); },
      [](json& line) { line["hash"] = std::string(64, 'f'); },
      [&](json& line) { line["hash"] = other; },
  };
  for (std::size_t i = 0; i < changes.size(); ++i) {
    const TemporaryFolder folder;
    std::filesystem::copy(calm.path(), folder.path(), std::filesystem::copy_options::recursive);
    std::filesystem::remove(folder / "results.jsonl");
    tamper(folder, 1, changes[i]);
    const ProgramRun run = batch(jobs, folder.path());
    EXPECT_EQ(run.status, 0) << i << ": " << run.err;
    EXPECT_THAT(run.out, HasSubstr("3 were there already")) << i;
    EXPECT_EQ(outputs_of_batch(folder.path()).size(), first.size()) << i;
  }
}

TEST(BatchCommand, WorksInAFolderOfOthersOnlyWithForce) {
  const TemporaryFolder inputs, folder;
  const std::string jobs =
      inputs.write("jobs.jsonl", route_job_of("lane:1/0/-1@10", "lane:7/0/1@55").dump() + "\n");
  folder.write("thesis.txt", "mine");
  const ProgramRun run = batch(jobs, folder.path());
  EXPECT_EQ(run.status, 3);
  EXPECT_THAT(run.err, HasSubstr("holds files already"));
  EXPECT_EQ(files_below(folder.path()), std::vector<std::string>{"thesis.txt"});
  EXPECT_EQ(batch(jobs, folder.path(), {"--force"}).status, 0);
  EXPECT_EQ(batch(jobs, folder.path()).status, 0);  // by now it is a batch's own
  EXPECT_EQ(bytes_of(folder / "thesis.txt"), "mine");
}

TEST(BatchCommand, ListsWhatIsMissingByHashAndLine) {
  const TemporaryFolder inputs, folder;
  const std::string lines = audit_jobs(inputs, 3) + "no job\n";
  const std::string jobs = inputs.write("jobs.jsonl", lines);
  const ProgramRun before = batch(jobs, folder / "made", {"--list-missing"});
  EXPECT_EQ(before.status, 0) << before.err;
  EXPECT_FALSE(std::filesystem::exists(folder / "made"));
  batch(jobs, folder.path());
  std::istringstream rows(before.out);
  std::istringstream expected(lines);
  for (int i = 0; i < 3; ++i) {
    std::string row, line;
    std::getline(rows, row);
    std::getline(expected, line);
    EXPECT_EQ(row,
              results_in(folder.path())[static_cast<std::size_t>(i)]["hash"].get<std::string>() +
                  "\t" + line);
  }
  EXPECT_EQ(batch(jobs, folder.path(), {"--list-missing"}).out, "");
}

TEST(BatchCommand, ListsTheWorstFirst) {
  const TemporaryFolder inputs, folder;
  const std::string jobs = inputs.write("jobs.jsonl", jobs_of_all_kinds(inputs));
  batch(jobs, folder.path());
  const json summary = json::parse(bytes_of(folder / "summary.json"));
  EXPECT_EQ(summary["jobs"], 13);
  EXPECT_EQ(summary["failed"], 2);
  const json& audits = summary["kinds"]["audit"];
  EXPECT_EQ(audits["jobs"], 6);
  std::map<std::size_t, double> least_m;
  for (const json& result : results_in(folder.path())) {
    if (result["job"] != "audit") continue;
    least_m[result["line"].get<std::size_t>()] =
        result["result"]["least_clearance_m"].get<double>();
  }
  double last_m = -1.0;
  bool was_done = false;
  for (const json& job : audits["worst"]) {
    const bool is_done = job["status"] == "done";
    EXPECT_GE(is_done, was_done);
    const double now_m = least_m.at(job["line"].get<std::size_t>());
    if (is_done == was_done) {
      EXPECT_GE(now_m, last_m);
    }
    was_done = is_done;
    last_m = now_m;
  }
  const std::string page = bytes_of(folder / "index.html");
  for (const std::string& file : files_below(folder / "files")) {
    EXPECT_THAT(page, HasSubstr("\"files/" + file + "\""));
  }
  EXPECT_THAT(page, Not(HasSubstr("://")));
}

TEST(BatchCommand, RefusesWrongUsage) {
  const TemporaryFolder folder;
  const std::string jobs = folder.write("jobs.jsonl", "");
  const std::string out = (folder / "out").string();
  const std::vector<std::vector<std::string>> wrong = {
      {"batch", "-o", out},
      {"batch", jobs},
      {"batch", jobs, "-o", out, "--memory", "much"},
      {"batch", jobs, "-o", out, "--time-limit", "5"},
      {"batch", jobs, "-o", out, "--serve"},
      {"batch", "-o", out, "--serve", "--merge"},
      {"batch", "-o", out, "--serve", "--json"},
      {"batch", "-o", out, "--serve", "--list-missing"},
      {"batch", jobs, "-o", out, "--list-missing", "--merge"},
      {"batch", jobs, "-o", out, "--list-missing", "--isolate"},
      {"batch", jobs, "-o", out, "--list-missing", "--json"},
      {"batch", jobs, "-o", out, "--list-missing", "--memory", "1GB"},
      {"batch", jobs, "-o", out, "--merge", "--isolate"},
  };
  for (const auto& words : wrong) EXPECT_EQ(run_roadbed(words).status, 2) << words.back();
  EXPECT_EQ(run_roadbed({"batch", (folder / "none").string(), "-o", out}).status, 3);
  EXPECT_FALSE(std::filesystem::exists(out));
}

TEST(BatchCommand, SaysWhatFailedFirstAndWhereTheRestIs) {
  const TemporaryFolder inputs, folder;
  const std::string lines = route_job_of("lane:1/0/-1@10", "lane:7/0/1@55").dump() +
                            "\n{\"job\":\"fly\"}\n{\"job\":\"import\"}\n";
  const std::string jobs = inputs.write("jobs.jsonl", lines);
  const ProgramRun run = batch(jobs, folder.path());
  EXPECT_THAT(run.out, HasSubstr("3 jobs: 1 done, 0 no, 2 failed"));
  EXPECT_THAT(run.err, HasSubstr("note: line 2 failed: job:/job: is \"fly\""));
  EXPECT_THAT(run.err, HasSubstr("wrote " + (folder / "index.html").string()));
  EXPECT_EQ(batch(jobs, folder.path(), {"--quiet"}).err, "");
}

TEST(BatchCommand, DoesNothingOfAnEmptyFileOfJobs) {
  const TemporaryFolder inputs, folder;
  const ProgramRun run = batch(inputs.write("jobs.jsonl", "\n \n"), folder.path());
  EXPECT_EQ(run.status, 0) << run.err;
  EXPECT_THAT(run.out, HasSubstr("0 jobs"));
  EXPECT_EQ(bytes_of(folder / "results.jsonl"), "");
}

/// What a journal's line says, changed.
std::string changed_line(const std::string& line, const json& changes) {
  json result = json::parse(line);
  result.update(changes);
  return result.dump() + "\n";
}

TEST(BatchCommand, MergesWhatOthersHaveRun) {
  const TemporaryFolder inputs, folder, other, calm;
  const std::string first = audit_jobs(inputs, 2);
  const std::string all = jobs_of_all_kinds(inputs);
  const std::string jobs = inputs.write("jobs.jsonl", all);
  batch(jobs, calm.path());
  batch(inputs.write("first.jsonl", first), folder.path());
  batch(inputs.write("rest.jsonl", all.substr(first.size())), other.path());
  const auto recursive = std::filesystem::copy_options::recursive;
  std::filesystem::copy(other / "files", folder / "files", recursive);
  std::filesystem::copy(other / "journal/000001.jsonl", folder / "journal/a worker.jsonl");
  const std::size_t runs = lines_below(folder / "journal");
  const ProgramRun merge = batch(jobs, folder.path(), {"--merge"});
  EXPECT_EQ(merge.status, 1) << merge.err;  // as some jobs have failed
  EXPECT_THAT(merge.out, HasSubstr("merged from 2 journals"));
  EXPECT_EQ(lines_below(folder / "journal"), runs);
  EXPECT_TRUE(outputs_of_batch(folder.path()) == outputs_of_batch(calm.path()));
}

TEST(BatchCommand, MergesNothingWhereAResultIsMissing) {
  const TemporaryFolder inputs, folder;
  const std::string jobs = inputs.write("jobs.jsonl", audit_jobs(inputs, 3));
  batch(inputs.write("first.jsonl", audit_jobs(inputs, 1)), folder.path());
  std::filesystem::remove(folder / "results.jsonl");
  const ProgramRun merge = batch(jobs, folder.path(), {"--merge"});
  EXPECT_EQ(merge.status, 3);
  EXPECT_THAT(merge.err, HasSubstr("2 jobs have no result; run without --merge"));
  EXPECT_FALSE(std::filesystem::exists(folder / "results.jsonl"));
}

TEST(BatchCommand, LetsWhatHasFailedStandWhereItMergesAndAnAnswerCountBeforeIt) {
  const TemporaryFolder inputs, folder;
  const std::string jobs = inputs.write("jobs.jsonl", audit_jobs(inputs, 2));
  batch(jobs, folder.path());
  std::istringstream journal(bytes_of(folder / "journal/000001.jsonl"));
  std::string one, two;
  std::getline(journal, one);
  std::getline(journal, two);
  const json crash = {{"status", "failed"},     {"exit", nullptr},         {"cause", "crash"},
                      {"result", nullptr},      {"reason", "worker lost"}, {"files", json::array()},
                      {"sha256", json::array()}};
  folder.write("journal/000001.jsonl", two + "\n");
  folder.write("journal/z.jsonl", changed_line(one, crash) + changed_line(two, crash));
  batch(jobs, folder.path(), {"--merge"});
  const auto results = results_in(folder.path());
  ASSERT_EQ(results.size(), 2U);
  EXPECT_EQ(results[0]["cause"], "crash");
  EXPECT_EQ(results[0]["reason"], "worker lost");
  EXPECT_EQ(results[1]["result"], json::parse(two)["result"]);
  EXPECT_THAT(batch(jobs, folder.path()).out, HasSubstr("1 were there already"));
}

TEST(BatchCommand, LinksFilesThatOthersHaveNamedAsTheyLike) {
  const TemporaryFolder inputs, folder;
  const std::string jobs = inputs.write("jobs.jsonl", audit_jobs(inputs, 1));
  batch(jobs, folder.path());
  folder.write("50% #1?.txt", "");
  std::istringstream journal(bytes_of(folder / "journal/000001.jsonl"));
  std::string line;
  std::getline(journal, line);
  const std::string sha256 = sha256sum_of_bytes("");
  folder.write("journal/000001.jsonl",
               changed_line(line, {{"files", {"50% #1?.txt"}}, {"sha256", json::array({sha256})}}));
  batch(jobs, folder.path(), {"--merge"});
  EXPECT_THAT(bytes_of(folder / "index.html"),
              HasSubstr("<a href=\"50%25%20%231%3F.txt\">50% #1?.txt</a>"));
}

// The system would read the file that is named before it.
TEST(BatchCommand, RefusesNamesOfFilesWithAZeroByte) {
  const TemporaryFolder folder;
  for (const std::string job :
       {R"({"job":"validate","inputs":["town.xodr\u0000x"]})",
        R"({"job":"audit","inputs":[],"options":{"trajectory":"a.csv\u0000x"}})"}) {
    const ProgramRun run = batch(folder.write("jobs.jsonl", job + "\n"), folder / "out");
    EXPECT_EQ(run.status, 1) << run.out;
    EXPECT_THAT(run.err, HasSubstr("holds a zero byte"));
  }
}

TEST(BatchCommand, RefusesJobsOfADevice) {
  const TemporaryFolder folder;
  const ProgramRun run = batch("/dev/zero", folder / "out");
  EXPECT_EQ(run.status, 3);
  EXPECT_THAT(run.err, HasSubstr("is no file or pipe"));
  EXPECT_FALSE(std::filesystem::exists(folder / "out"));
}

TEST(BatchCommand, WritesTheSameBytesHoweverItsFolderIsNamed) {
  const TemporaryFolder inputs;
  const json job = {{"job", "simulate"}, {"inputs", {(data_folder() / "drive.json").string()}}};
  const std::string jobs = inputs.write("jobs.jsonl", job.dump());
  std::filesystem::create_directory(inputs / "out");
  batch(jobs, inputs / "out");
  const auto plain = outputs_of_batch(inputs / "out");
  std::filesystem::remove_all(inputs / "out");
  batch(jobs, inputs / "out/../out/");
  EXPECT_TRUE(outputs_of_batch(inputs / "out") == plain);
}

}  // namespace
}  // namespace roadbed::tests
