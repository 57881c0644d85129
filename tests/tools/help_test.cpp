#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

#include "roadbed/tests/support/program_commands.h"
#include "roadbed/tests/support/program_run.h"

namespace roadbed::tests {
namespace {

std::size_t columns_of(const std::string& line) {
  return static_cast<std::size_t>(
      std::ranges::count_if(line, [](char byte) { return (byte & 0xC0) != 0x80; }));
}

TEST(Help, ListsEveryCommandAndItsParts) {
  const auto commands = all_commands();
  EXPECT_GE(commands.size(), 22U);
  EXPECT_TRUE(std::ranges::count(commands, std::vector<std::string>{"occupancy", "build"}) == 1);
}

TEST(Help, OfEveryCommandFitsAHundredColumnsAboveItsExample) {
  for (const auto& command : all_commands()) {
    for (const std::string& line : help_lines(command)) {
      if (line == "Example:") break;
      EXPECT_LE(columns_of(line), 100U) << command.front() << ": " << line;
    }
  }
}

TEST(Help, OfEveryCommandWithoutPartsEndsWithAnExample) {
  for (const auto& command : all_commands()) {
    const std::vector<std::string> lines = help_lines(command);
    if (!commands_in(lines).empty()) continue;
    EXPECT_EQ(std::ranges::count(lines, "Example:"), 1) << command.back();
    EXPECT_TRUE(lines.back().starts_with("  roadbed " + command.front())) << lines.back();
  }
}

TEST(Help, SaysLimitsDefaultsAndWhatExcludesInWords) {
  const std::vector<std::string> lines = help_lines({"occupancy", "build"});
  const auto has = [&](const std::string& text) {
    std::string all;
    for (const std::string& line : lines) all += line + ' ';
    return all.find(text) != std::string::npos;
  };
  EXPECT_TRUE(has("Side of a cell [m] (0.001 to 1000; default 0.1)"));
  EXPECT_TRUE(has("(not with --poses)"));
  EXPECT_TRUE(has("-o,--output PATH"));
}

TEST(Help, IsTheSameOfACommandAndOfHelp) {
  EXPECT_EQ(run_roadbed({"help"}).out, run_roadbed({"--help"}).out);
  for (std::vector<std::string> command : all_commands()) {
    std::vector<std::string> words = command;
    words.emplace_back("--help");
    command.insert(command.begin(), "help");
    EXPECT_EQ(run_roadbed(command).out, run_roadbed(words).out) << command.back();
  }
  const ProgramRun none = run_roadbed({"help", "occupancy", "bild"});
  EXPECT_EQ(none.status, 2);
  EXPECT_EQ(none.err,
            "roadbed: roadbed occupancy has no command bild; see: roadbed occupancy --help\n");
}

TEST(Help, NamesTheShortFormOfEveryOptionThatHasOne) {
  for (const auto& command : all_commands()) {
    for (const std::string& line : help_lines(command)) {
      for (const char* name : {"--quiet", "--force", "--json", "--output"}) {
        const bool begins = line.starts_with(std::string("  ") + name + " ");
        EXPECT_FALSE(begins) << command.front() << ": " << line;
      }
    }
  }
  const ProgramRun run = run_roadbed({"control", "design", "-q", "-j"});
  EXPECT_EQ(run.out, run_roadbed({"control", "design", "--quiet", "--json"}).out);
}

}  // namespace
}  // namespace roadbed::tests
