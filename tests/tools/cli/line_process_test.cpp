#include "roadbed/tools/cli/line_process.h"

#include <gtest/gtest.h>
#include <signal.h>
#include <unistd.h>

#include <chrono>
#include <string>

#include "roadbed/map/storage/output_file.h"

namespace roadbed::tools {
namespace {

LineProcess::Program shell(const std::string& script, bool restarts = false) {
  return {.file = "/bin/sh",
          .words = {"sh", "-c", script},
          .what = "a shell",
          .remedy = "none",
          .restarts = restarts};
}

TEST(LineProcess, AnswersLineByLine) {
  LineProcess process(shell("while read -r line; do echo \"<$line>\"; done"));
  EXPECT_EQ(process.process(), 0);
  for (const std::string line : {"one", "", "three words here"}) {
    const LineProcess::Answer answer = process.ask(line, 30.0);
    EXPECT_EQ(answer.line, "<" + line + ">");
    EXPECT_EQ(answer.death, "");
  }
  EXPECT_EQ(process.answered(), 3);
}

TEST(LineProcess, SaysHowItsProcessEnded) {
  const NoPipeSignal no_signal;
  LineProcess leaves(shell("read -r line; exit 3"));
  EXPECT_EQ(leaves.ask("go", 30.0).death, "its process ended with exit status 3");
  LineProcess dies(shell("read -r line; kill -SEGV $$"));
  EXPECT_EQ(dies.ask("go", 30.0).death, "killed by signal 11 (SIGSEGV)");
}

TEST(LineProcess, StartsAnewOverNoLineOnlyWhereItMay) {
  const NoPipeSignal no_signal;
  for (const bool restarts : {false, true}) {
    LineProcess once(shell("read -r line; echo \"$line\"", restarts));
    EXPECT_EQ(once.ask("first", 30.0).line, "first");
    ::usleep(200'000);  // it has ended by then; the kernel tells the writer
    const LineProcess::Answer answer = once.ask("second", 30.0);
    EXPECT_EQ(answer.line, restarts ? "second" : "");
    EXPECT_EQ(answer.death.empty(), restarts);
  }
}

TEST(LineProcess, EndsOneThatIsLateWithAllThatItStarted) {
  LineProcess process(shell("read -r line; sleep 1000 & sleep 1000; echo late"));
  const auto start = std::chrono::steady_clock::now();
  EXPECT_TRUE(process.ask("go", 0.2).is_late);
  EXPECT_LT(std::chrono::steady_clock::now() - start, std::chrono::seconds(60));
  EXPECT_EQ(process.process(), 0);
}

}  // namespace
}  // namespace roadbed::tools
