// On a terminal the program prints no colours, so that there is nothing that NO_COLOR
// (no-color.org) would have to switch off; bars of progress go to terminals only.

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <pty.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <string>
#include <vector>

#include "roadbed/tests/support/program_run.h"
#include "roadbed/tests/support/real_data.h"

namespace roadbed::tests {
namespace {

using testing::HasSubstr;
using testing::Not;

constexpr char kEscape = '\x1b';

/// What the program shows on a terminal of its own, both streams.
std::string shown_on_terminal(std::vector<std::string> words, bool no_color) {
  words.insert(words.begin(), program_file().string());
  std::vector<char*> argv;
  for (std::string& word : words) argv.push_back(word.data());
  argv.push_back(nullptr);
  int terminal = -1;
  const pid_t child = ::forkpty(&terminal, nullptr, nullptr, nullptr);
  if (child < 0) throw std::runtime_error("forkpty failed");
  if (child == 0) {
    ::setenv("TERM", "xterm-256color", 1);
    no_color ? ::setenv("NO_COLOR", "1", 1) : ::unsetenv("NO_COLOR");
    ::execv(argv[0], argv.data());
    ::_exit(127);
  }
  std::string shown, piece(4096, '\0');
  for (;;) {  // ends with EIO when the child has closed the terminal
    const ssize_t count = ::read(terminal, piece.data(), piece.size());
    if (count < 0 && errno == EINTR) continue;
    if (count <= 0) break;
    shown.append(piece, 0, static_cast<std::size_t>(count));
  }
  ::close(terminal);
  ::waitpid(child, nullptr, 0);
  return shown;
}

std::vector<std::vector<std::string>> runs(const TemporaryFolder& folder) {
  const std::string town = data_folder() / "town.xodr";
  const std::string jobs =
      folder.write("jobs.jsonl", R"({"job":"validate","inputs":[")" + town + "\"]}\n");
  return {{"--help"},
          {"route", "--help"},
          {"no-such-command"},
          {"info", "no_such_file"},
          {"info", town},
          {"validate", town},
          {"locate", town, "--at", "150,198"},
          {"route", town, "--from", "150,198", "--to", "lane:7/0/1@35"},
          {"batch", jobs, "-o", folder / "out"}};
}

TEST(Terminal, SeesNoColoursWithOrWithoutNoColor) {
  for (const bool no_color : {false, true}) {
    const TemporaryFolder folder;
    for (const auto& words : runs(folder)) {
      const std::string shown = shown_on_terminal(words, no_color);
      EXPECT_FALSE(shown.empty());
      EXPECT_EQ(shown.find(kEscape), std::string::npos) << shown;
    }
  }
}

TEST(Terminal, AloneSeesABarOfProgress) {
  const TemporaryFolder folder;
  const std::vector<std::string> batch = runs(folder).back();
  EXPECT_THAT(shown_on_terminal(batch, true), HasSubstr("] 1/1"));
  EXPECT_THAT(run_roadbed(batch).err, Not(HasSubstr("] 1/1")));
}

}  // namespace
}  // namespace roadbed::tests
