#include <gtest/gtest.h>

#include <algorithm>
#include <sstream>
#include <string>
#include <vector>

#include "roadbed/tests/support/program_run.h"

namespace roadbed::tests {
namespace {

std::vector<std::string> help_lines(std::vector<std::string> words) {
  words.push_back("--help");
  const ProgramRun run = run_roadbed(words);
  EXPECT_EQ(run.status, 0) << run.err;
  std::vector<std::string> lines;
  std::istringstream stream(run.out);
  for (std::string line; std::getline(stream, line);) lines.push_back(line);
  return lines;
}

/// The names that stand under "Subcommands:".
std::vector<std::string> commands_in(const std::vector<std::string>& help) {
  std::vector<std::string> names;
  auto line = std::ranges::find(help, "Subcommands:");
  if (line == help.end()) return names;
  for (++line; line != help.end() && line->starts_with("  "); ++line) {
    if ((*line)[2] != ' ') names.push_back(line->substr(2, line->find(' ', 2) - 2));
  }
  return names;
}

/// Every command's words, those of its parts too: {"occupancy", "build"}.
std::vector<std::vector<std::string>> all_commands() {
  std::vector<std::vector<std::string>> commands;
  for (const std::string& name : commands_in(help_lines({}))) {
    commands.push_back({name});
    for (const std::string& part : commands_in(help_lines({name})))
      commands.push_back({name, part});
  }
  return commands;
}

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

}  // namespace
}  // namespace roadbed::tests
