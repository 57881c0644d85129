// What becomes of a batch where something goes wrong: signals, crashes, full disks, torn files.

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>
#include <vector>

#include "roadbed/tests/support/file_size_limit.h"
#include "roadbed/tests/tools/batch/batch_runs.h"

namespace roadbed::tests {
namespace {

using testing::HasSubstr;

TEST(BatchFaults, GoesOnWhereItWasKilledAndEndsWithTheSameBytes) {
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

TEST(BatchFaults, StopsWhenItIsToldToAndCanGoOn) {
  const TemporaryFolder inputs, folder, calm;
  const std::string jobs = inputs.write("jobs.jsonl", audit_jobs(inputs, 60));
  batch(jobs, calm.path());
  const std::string err = (inputs / "err").string();
  Running running({"batch", jobs, "-o", folder.path().string()}, err);
  while (running.is_running() && !std::filesystem::exists(folder / "journal/000001.jsonl")) {
    wait_a_moment();
  }
  running.send(SIGSTOP);  // so that it is not done before it is told to
  running.send(SIGTERM);
  EXPECT_EQ(running.end(SIGCONT), 3);
  EXPECT_THAT(bytes_of(err), HasSubstr("run again to go on"));
  EXPECT_FALSE(std::filesystem::exists(folder / "results.jsonl"));
  batch(jobs, folder.path());
  EXPECT_TRUE(outputs_of_batch(folder.path()) == outputs_of_batch(calm.path()));
}

TEST(BatchFaults, KeepsTwoRunsOutOfOneFolder) {
  const TemporaryFolder inputs, folder;
  const std::string jobs = inputs.write("jobs.jsonl", audit_jobs(inputs, 60));
  Running running({"batch", jobs, "-o", folder.path().string()});
  while (running.is_running() && !std::filesystem::exists(folder / "journal/000001.jsonl")) {
    wait_a_moment();
  }
  running.send(SIGSTOP);
  const ProgramRun second = batch(jobs, folder.path());
  EXPECT_EQ(second.status, 3);
  EXPECT_THAT(second.err, HasSubstr("another run is at work in it"));
}

TEST(BatchFaults, WritesThroughNoLinkInItsFolder) {
  const TemporaryFolder inputs, victim;
  const std::string jobs = inputs.write("jobs.jsonl", audit_jobs(inputs, 1));
  const std::string foreign = victim.write("foreign", "mine");
  for (const char* name : {"results.jsonl", "summary.json", "index.html", "timings.jsonl"}) {
    const TemporaryFolder folder;
    folder.write("unfinished", "");
    std::filesystem::create_symlink(foreign, folder / name);
    const ProgramRun run = batch(jobs, folder.path());
    EXPECT_EQ(run.status, 3) << name;
    EXPECT_THAT(run.err, HasSubstr(std::string(name) + ": is a link"));
    EXPECT_EQ(bytes_of(foreign), "mine") << name;
  }
}

TEST(BatchFaults, MakesACrashOneFailedLineAndRunsItAgain) {
  const TemporaryFolder inputs, folder, calm;
  const std::string jobs = inputs.write("jobs.jsonl", audit_jobs(inputs, 60));
  batch(jobs, calm.path());
  // LeakSanitizer looks from a child, which is none to kill.
  ::setenv("ASAN_OPTIONS", "detect_leaks=0", 1);  // NOLINT(concurrency-mt-unsafe): no threads here
  Running running({"batch", jobs, "-o", folder.path().string(), "--isolate"});
  ::unsetenv("ASAN_OPTIONS");  // NOLINT(concurrency-mt-unsafe)
  // AddressSanitizer makes an exit of SIGSEGV, not of SIGABRT.
  while (running.is_running()) {
    for (const pid_t child : children_of(running.process())) ::kill(child, SIGABRT);
    for (int i = 0; i < 10; ++i) wait_a_moment();
  }
  EXPECT_EQ(running.status(), 1);
  int crashes = 0;
  for (const json& result : results_in(folder.path())) {
    if (result["cause"] != "crash") continue;
    ++crashes;
    EXPECT_EQ(result["reason"], "killed by signal 6 (SIGABRT)");
    EXPECT_TRUE(result["files"].empty());
  }
  EXPECT_GT(crashes, 0);
  batch(jobs, folder.path(), {"--isolate"});
  EXPECT_TRUE(outputs_of_batch(folder.path()) == outputs_of_batch(calm.path()));
}

constexpr std::size_t kPadding = 300'000;

TEST(BatchFaults, EndsAJobThatHangsAtItsTimeLimit) {
  const TemporaryFolder inputs, folder;
  // Lines that are longer than what fits into a pipe, so that even sending one may hang.
  std::string lines = audit_jobs(inputs, 30);
  for (std::size_t end = 0; (end = lines.find('\n', end)) != std::string::npos;
       end += kPadding + 1) {
    lines.insert(end, kPadding, ' ');
  }
  const std::string jobs = inputs.write("jobs.jsonl", lines);
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

TEST(BatchFaults, FailsAJobWhoseFilesFindNoRoomAndRunsItAgain) {
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

TEST(BatchFaults, StopsWhereTheJournalFindsNoRoomAndCanGoOn) {
  const TemporaryFolder inputs, folder, calm;
  const std::string jobs = inputs.write("jobs.jsonl", audit_jobs(inputs, 3));
  batch(jobs, calm.path());
  {
    const FileSizeLimit limit(300);
    const ProgramRun run = batch(jobs, folder.path());
    EXPECT_EQ(run.status, 3);
    EXPECT_THAT(run.err, HasSubstr("000001.jsonl"));
    EXPECT_THAT(run.err, HasSubstr("run again"));
  }
  EXPECT_FALSE(std::filesystem::exists(folder / "results.jsonl"));
  batch(jobs, folder.path());
  EXPECT_TRUE(outputs_of_batch(folder.path()) == outputs_of_batch(calm.path()));
}

TEST(BatchFaults, ASecondSignalOfAnotherKindEndsTheRun) {
  const TemporaryFolder inputs, folder;
  const std::string jobs = inputs.write("jobs.jsonl", audit_jobs(inputs, 30));
  Running running({"batch", jobs, "-o", folder.path().string(), "--isolate"});
  std::vector<pid_t> children;
  while (running.is_running() && children.empty()) children = children_of(running.process());
  ASSERT_FALSE(children.empty());
  ::kill(children.front(), SIGSTOP);  // its job never ends
  running.send(SIGINT);
  const auto catches_terminate = [&] {
    std::ifstream status("/proc/" + std::to_string(running.process()) + "/status");
    for (std::string line; std::getline(status, line);) {
      if (line.starts_with("SigCgt:")) {
        return (std::stoull(line.substr(7), nullptr, 16) >> (SIGTERM - 1) & 1U) != 0;
      }
    }
    return false;
  };
  while (catches_terminate()) wait_a_moment();
  EXPECT_TRUE(running.is_running());
  EXPECT_EQ(running.end(SIGTERM), 128 + SIGTERM);
  ::kill(children.front(), SIGKILL);  // whoever ends the run so leaves its jobs
}

TEST(BatchFaults, SweepsOnlyItsOwnHalfWrittenFiles) {
  const TemporaryFolder inputs, folder;
  const std::string jobs = inputs.write("jobs.jsonl", audit_jobs(inputs, 1));
  for (const char* name : {"files/ab/c", "journal", "tables", "mine"}) {
    std::filesystem::create_directories(folder / name);
  }
  const std::vector<std::string> users = {".gitignore", "mine/.keep", ".results", ".git.html.1-0"};
  const std::vector<std::string> left = {
      ".results.jsonl.7-0",  ".index.html.7-1", "files/ab/c/.report.html.7-2",
      "files/ab/.x.rbm.7-3", "journal/.a",      "tables/.b"};
  for (const auto& names : {users, left}) {
    for (const std::string& name : names) folder.write(name, "");
  }
  batch(jobs, folder.path());
  for (const std::string& name : left) EXPECT_TRUE(std::filesystem::exists(folder / name));
  folder.write("unfinished", "");
  batch(jobs, folder.path());
  for (const std::string& name : users) EXPECT_TRUE(std::filesystem::exists(folder / name)) << name;
  for (const std::string& name : left) EXPECT_FALSE(std::filesystem::exists(folder / name)) << name;
}

TEST(BatchFaults, PassesOverTornAndStrangeLinesOfJournals) {
  const TemporaryFolder inputs, folder;
  const std::string jobs = inputs.write("jobs.jsonl", audit_jobs(inputs, 5));
  batch(jobs, folder.path());
  const auto whole = outputs_of_batch(folder.path());
  const std::string journal = bytes_of(folder / "journal/000001.jsonl");
  const std::size_t last = journal.rfind('\n', journal.size() - 2) + 1;
  for (const std::size_t size : {last + 1, (last + journal.size()) / 2, journal.size() - 1}) {
    std::filesystem::remove_all(folder / "journal");
    std::filesystem::create_directory(folder / "journal");
    folder.write("journal/000001.jsonl", journal.substr(0, size));
    folder.write("journal/000002.jsonl", "{}\n[1,\n\n\xff\xfe\n{\"hash\":3}\nnull\n");
    EXPECT_THAT(batch(jobs, folder.path()).out, HasSubstr("4 were there already")) << size;
    EXPECT_TRUE(outputs_of_batch(folder.path()) == whole);
  }
}

TEST(BatchFaults, FailsAJobThatNeedsMoreMemoryThanItMay) {
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
  GTEST_SKIP() << "a sanitizer ends a program that finds no memory";
#endif
  const TemporaryFolder inputs, folder;
  const std::string large = inputs.write("large.xodr", "<OpenDRIVE>");
  std::filesystem::resize_file(large, std::uintmax_t{500'000'000});  // of zeros, on no disk
  const auto import_of = [](const std::string& map) {
    return json{{"job", "import"}, {"inputs", {map}}}.dump() + "\n";
  };
  const std::string lines = import_of(kTownOfBatch) + import_of(large) +
                            route_job_of("lane:1/0/-1@10", "lane:7/0/1@55").dump() + "\n";
  const std::string jobs = inputs.write("jobs.jsonl", lines);
  batch(jobs, folder.path(), {"--isolate", "--job-memory", "300MB"});
  const auto results = results_in(folder.path());
  ASSERT_EQ(results.size(), 3U);
  EXPECT_EQ(results[0]["status"], "done") << results[0]["reason"];
  EXPECT_EQ(results[1]["cause"], "memory") << results[1]["reason"];
  EXPECT_EQ(results[1]["reason"], "needed more than 300MB");
  EXPECT_TRUE(results[1]["files"].empty());
  EXPECT_EQ(results[2]["status"], "done") << results[2]["reason"];
}

TEST(BatchFaults, SaysThatTheDiskIsFullWhereAFolderOfScenariosFindsNoRoom) {
  const TemporaryFolder inputs, folder;
  std::filesystem::create_directory(inputs / "drives");
  for (const char* name : {"town.xodr", "town.bt", "drive.json"}) {
    std::filesystem::copy_file(data_folder() / name, (inputs / "drives") / name);
  }
  const json job = {{"job", "simulate"}, {"inputs", {(inputs / "drives").string()}}};
  const std::string jobs = inputs.write("jobs.jsonl", job.dump());
  {
    const FileSizeLimit limit(20'000);
    batch(jobs, folder.path());
  }
  const json result = results_in(folder.path()).at(0);
  EXPECT_EQ(result["cause"], "disk") << result["reason"];
  EXPECT_TRUE(result["files"].empty());
}

TEST(BatchFaults, RefusesAnInputThatTheSystemMakesUpWhenItIsRead) {
  const TemporaryFolder inputs, folder;
  std::string lines;
  for (const char* input : {"/proc", "/proc/kmsg", "/proc/self/mem", "/sys"}) {
    lines += json{{"job", "validate"}, {"inputs", {input}}}.dump() + "\n";
  }
  const ProgramRun run = batch(inputs.write("jobs.jsonl", lines), folder.path());
  EXPECT_EQ(run.status, 1);
  const std::vector<json> results = results_in(folder.path());
  ASSERT_EQ(results.size(), 4u);
  for (const json& result : results) EXPECT_EQ(result["status"], "failed") << result;
  EXPECT_THAT(results[0]["reason"].get<std::string>(), HasSubstr("/proc: is a folder of the"));
}

}  // namespace
}  // namespace roadbed::tests
