// `batch` as a user runs it, on the project's own town.

#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <spawn.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>
#include <thread>
#include <vector>

#include "roadbed/tests/support/program_run.h"
#include "roadbed/tests/support/real_data.h"

namespace roadbed::tests {
namespace {

using nlohmann::json;
using testing::HasSubstr;
using testing::Not;

const std::string kTownOfBatch = (data_folder() / "town.xodr").string();

/// A straight drive of 1 s, so far to the side of one through the town's street.
std::string drive_csv(double aside_m) {
  std::ostringstream csv;
  csv << "t_s,x_m,y_m,heading_rad,speed_mps,acceleration_mps2,steering_rad,curvature_per_m\n";
  for (int i = 0; i <= 10; ++i) {
    csv << 0.1 * i << ',' << 150.0 + i << ',' << 198.0 + aside_m << ",0,10,0,0,0\n";
  }
  return csv.str();
}

/// A wall of 1 m height beside the drives, made once for a folder.
std::string wall_in(const TemporaryFolder& inputs) {
  const std::string cells = (inputs / "wall.bt").string();
  if (std::filesystem::exists(cells)) return cells;
  std::string cloud;
  for (int i = 0; i < 150; ++i) {
    for (const char* height : {" 0.3\n", " 0.7\n", " 1.1\n"}) {
      cloud += std::to_string(145.0 + 0.2 * i) + " 201.0" + height;
    }
  }
  const ProgramRun run = run_roadbed(
      {"occupancy", "build", inputs.write("wall.xyz", cloud), "-o", cells, "--resolution", "0.1"});
  EXPECT_EQ(run.status, 0) << run.err;
  return cells;
}

json audit_job(const TemporaryFolder& inputs, const std::string& drive) {
  return {{"job", "audit"},
          {"options", {{"occupancy", wall_in(inputs)}, {"trajectory", drive}, {"unknown", "free"}}},
          {"outputs", {"certificate", "report"}}};
}

json route_job_of(const std::string& from, const std::string& to) {
  return {{"job", "route"}, {"inputs", {kTownOfBatch}}, {"options", {{"from", from}, {"to", to}}}};
}

std::string audit_jobs(const TemporaryFolder& inputs, int audits) {
  std::string lines;
  for (int i = 0; i < audits; ++i) {
    const std::string name = "drive_" + std::to_string(i) + ".csv";
    lines +=
        audit_job(inputs, inputs.write(name, drive_csv(0.7 * (i % 9) + 0.01 * i))).dump() + "\n";
  }
  return lines;
}

/// Jobs of every kind, some with an answer that is no, some that fail.
std::string jobs_of_all_kinds(const TemporaryFolder& inputs) {
  std::string lines = audit_jobs(inputs, 6);
  const auto add = [&](const json& job) { lines += job.dump() + "\n"; };
  add(route_job_of("lane:1/0/-1@10", "lane:7/0/1@55"));
  add({{"job", "import"}, {"inputs", {kTownOfBatch}}});
  add({{"job", "validate"}, {"inputs", {kTownOfBatch}}, {"outputs", {"sarif", "svg"}}});
  add({{"job", "simulate"}, {"inputs", {(data_folder() / "scenarios/cut_in.json").string()}}});
  add({{"job", "import"}, {"inputs", {(inputs / "missing.xodr").string()}}});
  add(route_job_of("lane:1/0/-1@10", "lane:7/0/1@55"));  // once more
  lines += "{\"job\":\"audit\"\n\n";
  return lines;
}

ProgramRun batch(const std::string& jobs, const std::filesystem::path& folder,
                 std::vector<std::string> more = {}) {
  std::vector<std::string> words{"batch", jobs, "-o", folder.string()};
  words.insert(words.end(), more.begin(), more.end());
  return run_roadbed(words);
}

/// The bytes of everything that is the same for every run of the same jobs.
std::map<std::string, std::string> outputs_of_batch(const std::filesystem::path& folder) {
  std::map<std::string, std::string> outputs;
  for (const std::string& file : files_below(folder)) {
    const bool is_of_run =
        file == "lock" || file == "timings.jsonl" || file.starts_with("journal/");
    if (!is_of_run) outputs[file] = bytes_of(folder / file);
  }
  return outputs;
}

std::vector<json> results_in(const std::filesystem::path& folder) {
  std::ifstream stream(folder / "results.jsonl");
  std::vector<json> results;
  for (std::string line; std::getline(stream, line);) results.push_back(json::parse(line));
  return results;
}

std::size_t lines_below(const std::filesystem::path& folder) {
  std::size_t count = 0;
  for (const std::string& file : files_below(folder)) {
    const std::string bytes = bytes_of(folder / file);
    count += static_cast<std::size_t>(std::ranges::count(bytes, '\n'));
  }
  return count;
}

/// The program, running beside the test.
class Running {
 public:
  explicit Running(std::vector<std::string> words, const std::string& err = "/dev/null") {
    words.insert(words.begin(), program_file().string());
    std::vector<char*> argv;
    for (std::string& word : words) argv.push_back(word.data());
    argv.push_back(nullptr);
    posix_spawn_file_actions_t actions;
    posix_spawn_file_actions_init(&actions);
    posix_spawn_file_actions_addopen(&actions, 1, "/dev/null", O_WRONLY, 0);
    posix_spawn_file_actions_addopen(&actions, 2, err.c_str(), O_WRONLY | O_CREAT, 0600);
    EXPECT_EQ(::posix_spawn(&child_, argv[0], &actions, nullptr, argv.data(), environ), 0);
    posix_spawn_file_actions_destroy(&actions);
  }
  ~Running() {
    if (child_ != 0) end(SIGKILL);
  }
  Running(const Running&) = delete;
  Running& operator=(const Running&) = delete;

  pid_t process() const { return child_; }

  bool is_running() {
    if (child_ != 0 && ::waitpid(child_, &status_, WNOHANG) == child_) child_ = 0;
    return child_ != 0;
  }

  /// Its exit status, 128 + signal if it was killed.
  int end(int signal) {
    if (child_ != 0) {
      ::kill(child_, signal);
      ::waitpid(child_, &status_, 0);
      child_ = 0;
    }
    return status();
  }

  int status() const { return WIFEXITED(status_) ? WEXITSTATUS(status_) : 128 + WTERMSIG(status_); }

 private:
  pid_t child_ = 0;
  int status_ = 0;
};

void wait_a_moment() { std::this_thread::sleep_for(std::chrono::milliseconds(5)); }

/// Children of a process: those that its threads started.
std::vector<pid_t> children_of(pid_t process) {
  std::vector<pid_t> children;
  std::error_code error;
  const std::string tasks = "/proc/" + std::to_string(process) + "/task";
  for (const auto& task : std::filesystem::directory_iterator(tasks, error)) {
    std::ifstream list(task.path() / "children");
    for (pid_t child = 0; list >> child;) children.push_back(child);
  }
  return children;
}

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

TEST(BatchCommand, RunsAgainAJobOneOfWhoseFilesIsGone) {
  const TemporaryFolder inputs, folder;
  const std::string jobs = inputs.write("jobs.jsonl", audit_jobs(inputs, 13));
  batch(jobs, folder.path());
  const auto first = outputs_of_batch(folder.path());
  std::filesystem::remove(folder / results_in(folder.path())[2]["files"][0].get<std::string>());
  EXPECT_THAT(batch(jobs, folder.path()).out, HasSubstr("12 were there already"));
  EXPECT_TRUE(outputs_of_batch(folder.path()) == first);
}

TEST(BatchCommand, GoesOnWhereItWasKilledAndEndsWithTheSameBytes) {
  const TemporaryFolder inputs, folder, calm;
  const std::string jobs = inputs.write("jobs.jsonl", audit_jobs(inputs, 60));
  batch(jobs, calm.path());
  std::size_t before = 0;
  for (int kill = 0; kill < 4; ++kill) {
    Running running({"batch", jobs, "-o", folder.path().string(), "--threads", "2"});
    while (running.is_running()) {  // so long that it has done something more
      if (std::filesystem::exists(folder / "journal") &&
          lines_below(folder / "journal") > before + 5)
        break;
      wait_a_moment();
    }
    running.end(SIGKILL);
    const std::size_t after = lines_below(folder / "journal");
    EXPECT_GE(after, before);
    before = after;
  }
  batch(jobs, folder.path(), {"--threads", "2"});
  EXPECT_TRUE(outputs_of_batch(folder.path()) == outputs_of_batch(calm.path()));
}

TEST(BatchCommand, StopsWhenItIsToldToAndCanGoOn) {
  const TemporaryFolder inputs, folder, calm;
  const std::string jobs = inputs.write("jobs.jsonl", audit_jobs(inputs, 60));
  batch(jobs, calm.path());
  const std::string err = (inputs / "err").string();
  Running running({"batch", jobs, "-o", folder.path().string()}, err);
  while (running.is_running() && !std::filesystem::exists(folder / "journal/000001.jsonl")) {
    wait_a_moment();
  }
  EXPECT_EQ(running.end(SIGTERM), 1);
  EXPECT_THAT(bytes_of(err), HasSubstr("run again to go on"));
  EXPECT_FALSE(std::filesystem::exists(folder / "results.jsonl"));
  batch(jobs, folder.path());
  EXPECT_TRUE(outputs_of_batch(folder.path()) == outputs_of_batch(calm.path()));
}

TEST(BatchCommand, KeepsTwoRunsOutOfOneFolder) {
  const TemporaryFolder inputs, folder;
  const std::string jobs = inputs.write("jobs.jsonl", audit_jobs(inputs, 60));
  Running running({"batch", jobs, "-o", folder.path().string()});
  while (running.is_running() && !std::filesystem::exists(folder / "journal/000001.jsonl")) {
    wait_a_moment();
  }
  const ProgramRun second = batch(jobs, folder.path());
  EXPECT_EQ(second.status, 1);
  EXPECT_THAT(second.err, HasSubstr("another run is at work in it"));
}

TEST(BatchCommand, MakesACrashOneFailedLineAndRunsItAgain) {
  const TemporaryFolder inputs, folder, calm;
  const std::string jobs = inputs.write("jobs.jsonl", audit_jobs(inputs, 60));
  batch(jobs, calm.path());
  Running running({"batch", jobs, "-o", folder.path().string(), "--isolate"});
  while (running.is_running()) {
    for (const pid_t child : children_of(running.process())) ::kill(child, SIGSEGV);
    for (int i = 0; i < 10; ++i) wait_a_moment();
  }
  EXPECT_EQ(running.status(), 1);
  int crashes = 0;
  for (const json& result : results_in(folder.path())) {
    if (result["cause"] != "crash") continue;
    ++crashes;
    EXPECT_EQ(result["reason"], "killed by signal 11 (SIGSEGV)");
    EXPECT_TRUE(result["files"].empty());
  }
  EXPECT_GT(crashes, 0);
  batch(jobs, folder.path(), {"--isolate"});
  EXPECT_TRUE(outputs_of_batch(folder.path()) == outputs_of_batch(calm.path()));
}

TEST(BatchCommand, EndsAJobThatHangsAtItsTimeLimit) {
  const TemporaryFolder inputs, folder;
  const std::string jobs = inputs.write("jobs.jsonl", audit_jobs(inputs, 30));
  Running running({"batch", jobs, "-o", folder.path().string(), "--isolate", "--time-limit", "10"});
  std::vector<pid_t> children;
  while (running.is_running() && children.empty()) children = children_of(running.process());
  ASSERT_FALSE(children.empty());
  // Stopped for ever as soon as it has read its job, or will.
  ::kill(children.front(), SIGSTOP);
  while (running.is_running()) wait_a_moment();
  int late = 0;
  for (const json& result : results_in(folder.path())) late += result["cause"] == "time";
  EXPECT_EQ(late, 1);
  EXPECT_THAT(bytes_of(folder / "results.jsonl"), HasSubstr("took longer than 10 s"));
}

/// Lets files of processes that are started grow to so many bytes while it lives.
class FileSizeLimit {
 public:
  explicit FileSizeLimit(rlim_t bytes) {
    ::getrlimit(RLIMIT_FSIZE, &before_);
    const rlimit limit{.rlim_cur = bytes, .rlim_max = before_.rlim_max};
    ::setrlimit(RLIMIT_FSIZE, &limit);
  }
  ~FileSizeLimit() { ::setrlimit(RLIMIT_FSIZE, &before_); }
  FileSizeLimit(const FileSizeLimit&) = delete;
  FileSizeLimit& operator=(const FileSizeLimit&) = delete;

 private:
  rlimit before_{};
};

TEST(BatchCommand, FailsAJobWhoseFilesFindNoRoomAndRunsItAgain) {
  const TemporaryFolder inputs, folder, calm;
  const std::string jobs = inputs.write("jobs.jsonl", audit_jobs(inputs, 3));
  batch(jobs, calm.path());
  {
    const FileSizeLimit limit(60'000);  // a report is larger, the journal is not
    batch(jobs, folder.path());
  }
  int without_room = 0;
  for (const json& result : results_in(folder.path())) {
    if (result["cause"] != "disk") continue;
    ++without_room;
    EXPECT_THAT(result["reason"].get<std::string>(), HasSubstr("cannot be written"));
    EXPECT_TRUE(result["files"].empty());
  }
  EXPECT_GE(without_room, 3);
  batch(jobs, folder.path());
  EXPECT_TRUE(outputs_of_batch(folder.path()) == outputs_of_batch(calm.path()));
}

TEST(BatchCommand, StopsWhereTheJournalFindsNoRoomAndCanGoOn) {
  const TemporaryFolder inputs, folder, calm;
  const std::string jobs = inputs.write("jobs.jsonl", audit_jobs(inputs, 3));
  batch(jobs, calm.path());
  {
    const FileSizeLimit limit(300);
    const ProgramRun run = batch(jobs, folder.path());
    EXPECT_EQ(run.status, 1);
    EXPECT_THAT(run.err, HasSubstr("000001.jsonl"));
    EXPECT_THAT(run.err, HasSubstr("run again"));
  }
  EXPECT_FALSE(std::filesystem::exists(folder / "results.jsonl"));
  batch(jobs, folder.path());
  EXPECT_TRUE(outputs_of_batch(folder.path()) == outputs_of_batch(calm.path()));
}

TEST(BatchCommand, ListsWhatIsMissingByHashAndLine) {
  const TemporaryFolder inputs, folder;
  const std::string lines = audit_jobs(inputs, 3) + "no job\n";
  const std::string jobs = inputs.write("jobs.jsonl", lines);
  const ProgramRun before = batch(jobs, folder.path(), {"--list-missing"});
  EXPECT_EQ(before.status, 0) << before.err;
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
  };
  for (const auto& words : wrong) EXPECT_EQ(run_roadbed(words).status, 2) << words.back();
  EXPECT_EQ(run_roadbed({"batch", (folder / "none").string(), "-o", out}).status, 1);
  EXPECT_FALSE(std::filesystem::exists(out));
}

TEST(BatchCommand, DoesNothingOfAnEmptyFileOfJobs) {
  const TemporaryFolder inputs, folder;
  const ProgramRun run = batch(inputs.write("jobs.jsonl", "\n \n"), folder.path());
  EXPECT_EQ(run.status, 0) << run.err;
  EXPECT_THAT(run.out, HasSubstr("0 jobs"));
  EXPECT_EQ(bytes_of(folder / "results.jsonl"), "");
}

}  // namespace
}  // namespace roadbed::tests
