// What cannot be printed is an error of every command, never a success.

#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <filesystem>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include "roadbed/tests/support/program_run.h"
#include "roadbed/tests/support/real_data.h"

namespace roadbed::tests {
namespace {

using testing::HasSubstr;
using Words = std::vector<std::string>;

/// A standard output that takes nothing.
class Unwritable {
 public:
  explicit Unwritable(int descriptor, std::string reason)
      : descriptor_(descriptor), reason_(std::move(reason)) {}
  ~Unwritable() {
    if (descriptor_ >= 0) ::close(descriptor_);
  }
  Unwritable(const Unwritable&) = delete;
  Unwritable& operator=(const Unwritable&) = delete;

  int descriptor() const { return descriptor_; }
  const std::string& reason() const { return reason_; }

 private:
  int descriptor_;
  std::string reason_;
};

int full_disk() { return ::open("/dev/full", O_WRONLY | O_CLOEXEC); }

/// A pipe that nobody reads any more.
int left_pipe() {
  std::array<int, 2> ends{};
  EXPECT_EQ(::pipe2(ends.data(), O_CLOEXEC), 0);
  ::close(ends[0]);
  return ends[1];
}

/// Some parents leave it to their children so.
class IgnoredPipeSignal {
 public:
  IgnoredPipeSignal() : before_(::signal(SIGPIPE, SIG_IGN)) {}
  ~IgnoredPipeSignal() { ::signal(SIGPIPE, before_); }
  IgnoredPipeSignal(const IgnoredPipeSignal&) = delete;
  IgnoredPipeSignal& operator=(const IgnoredPipeSignal&) = delete;

 private:
  sighandler_t before_;
};

class StandardOutput : public testing::Test {
 protected:
  void SetUp() override {
    run({"simulate", scenario_, "-o", drive_});
    run({"occupancy", "build", data("scenarios/narrow_gap.pcd"), "-o", octree_});
    jobs_ = folder_.write("jobs.jsonl", job_ + "\n");
  }

  static std::string data(const std::string& name) { return (data_folder() / name).string(); }

  static void run(const Words& words) {
    const ProgramRun run = run_roadbed(words);
    ASSERT_EQ(run.status, 0) << run.err;
  }

  /// An output that is not there yet.
  std::string fresh(const std::string& suffix = "") {
    return folder_ / ("out" + std::to_string(++outputs_) + suffix);
  }

  /// A run of each command that prints; others have nothing to print but their help.
  std::vector<Words> printing() {
    const std::string trajectory = drive_ + "/trajectory.csv";
    return {
        {"--help"},
        {"--version"},
        {"import", "--help"},
        {"info", crossing_},
        {"info", crossing_, "--json"},
        {"validate", crossing_, "--json"},
        {"export", "--help"},
        {"convert", "--help"},
        {"help", "route"},
        {"diff", crossing_, crossing_},
        {"map", "diff", crossing_, crossing_},
        {"locate", town_, "--at", "270,205"},
        {"route", town_, "--from", from_, "--to", to_},
        {"route", town_, "--from", from_, "--to", to_, "--json"},
        {"reach", town_, "--from", from_, "--within", "10s"},
        {"reference", "--help"},
        {"plan", scenario_, "-o", fresh()},
        {"control", "design"},
        {"drive", "info", trajectory},
        {"simulate", scenario_, "-o", fresh()},
        {"pilot", "--help"},
        {"occupancy", "info", octree_},
        {"occupancy", "export", "--help"},
        {"occupancy", "diff", octree_, octree_},
        {"audit", "--occupancy", octree_, "--trajectory", trajectory, "--json"},
        {"figures", "-o", fresh()},
        {"report", "compare", drive_, drive_},
        {"batch", jobs_, "-o", fresh()},
        {"batch", jobs_, "-o", fresh(), "--list-missing"},
        {"jobs", "--help"},
    };
  }

  void expect_error(const Words& words, const Unwritable& out) {
    const ProgramRun run = run_roadbed_into(out.descriptor(), words);
    const std::string line =
        "roadbed: standard output: cannot be written: " + out.reason() + "; send it to ";
    std::string command = "roadbed";
    for (const std::string& word : words) command += " " + word;
    EXPECT_EQ(run.status, 3) << command;
    EXPECT_THAT(run.err, HasSubstr(line)) << command;
    EXPECT_EQ(run.err.find("standard output"), run.err.rfind("standard output")) << run.err;
  }

  TemporaryFolder folder_;
  const std::string town_ = data("town.xodr"), crossing_ = data("crossing.osm"),
                    scenario_ = data("scenarios/cut_in.json"), from_ = "lane:1/0/-1@10",
                    to_ = "lane:7/0/1@55", drive_ = folder_ / "drive", octree_ = folder_ / "gap.bt";
  const std::string job_ = R"({"job":"route","inputs":[")" + town_ + R"("],"options":{"from":")" +
                           from_ + R"(","to":")" + to_ + R"("}})";
  std::string jobs_;
  int outputs_ = 0;
};

TEST_F(StandardOutput, OnAFullDiskIsAnErrorOfEveryCommand) {
  const Unwritable full(full_disk(), "No space left on device");
  for (const Words& words : printing()) expect_error(words, full);
}

TEST_F(StandardOutput, ThatIsClosedIsAnErrorOfEveryCommand) {
  const Unwritable closed(-1, "Bad file descriptor");
  for (const Words& words : printing()) expect_error(words, closed);
}

TEST_F(StandardOutput, ThatNobodyReadsIsAnErrorWhereItsSignalIsIgnored) {
  const IgnoredPipeSignal ignored;
  const Unwritable pipe(left_pipe(), "Broken pipe");
  for (const Words& words : printing()) expect_error(words, pipe);
}

TEST_F(StandardOutput, ThatNobodyReadsEndsTheProgramByItsSignalElsewhere) {
  const Unwritable pipe(left_pipe(), "");
  EXPECT_EQ(run_roadbed_into(pipe.descriptor(), {"info", crossing_}).status, 128 + SIGPIPE);
}

TEST_F(StandardOutput, IsTriedWithEveryCommandThatHelpNames) {
  std::set<std::string> tried;
  for (const Words& words : printing()) tried.insert(words.front());
  std::istringstream help(run_roadbed({"--help"}).out);
  std::string line;
  while (std::getline(help, line) && !line.starts_with("Subcommands:")) {
  }
  int commands = 0;
  while (std::getline(help, line) && line.starts_with("  ")) {
    if (line[2] == ' ') continue;  // goes on from the line before
    const std::string name = line.substr(2, line.find(' ', 2) - 2);
    EXPECT_EQ(tried.count(name), 1U) << name;
    ++commands;
  }
  EXPECT_GT(commands, 10);
}

TEST_F(StandardOutput, IsNoMatterWhereNothingIsPrinted) {
  for (const int descriptor : {-1, full_disk()}) {
    const std::string map = fresh(".rbm"), csv = fresh(".csv");
    EXPECT_EQ(run_roadbed_into(descriptor, {"import", town_, "-o", map}).status, 0);
    EXPECT_EQ(run_roadbed_into(descriptor, {"export", map, "-o", csv}).status, 0);
    EXPECT_GT(std::filesystem::file_size(csv), 1000U);
    if (descriptor >= 0) ::close(descriptor);
  }
}

// A file that is opened gets the lowest number that is free.
TEST_F(StandardOutput, ThatIsClosedIsNotTakenForAFileThatIsOpenMeanwhile) {
  const std::string closed = fresh(), open = fresh();
  EXPECT_EQ(run_roadbed_into(-1, {"batch", jobs_, "-o", closed}).status, 3);
  run({"batch", jobs_, "-o", open});
  ASSERT_EQ(files_below(closed), files_below(open));
  EXPECT_EQ(bytes_of(closed + "/lock"), bytes_of(open + "/lock"));
}

TEST_F(StandardOutput, OfAServedBatchIsAnErrorToo) {
  const std::string err = folder_ / "serve_err";
  const std::string words = " batch --serve -o " + fresh() + " < " + jobs_ + " 2> " + err + " > ";
  const int status = std::system((program_file().string() + words + "/dev/full").c_str());
  EXPECT_EQ(WEXITSTATUS(status), 3);
  const std::string line = bytes_of(err);
  EXPECT_THAT(line, HasSubstr("roadbed: standard output: cannot be written: No space left on "));
  EXPECT_EQ(std::ranges::count(line, '\n'), 1) << line;
  EXPECT_EQ(std::system((program_file().string() + words + "/dev/null").c_str()), 0);
}

}  // namespace
}  // namespace roadbed::tests
