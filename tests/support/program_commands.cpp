#include "roadbed/tests/support/program_commands.h"

#include <algorithm>
#include <sstream>
#include <stdexcept>

#include "roadbed/tests/support/program_run.h"

namespace roadbed::tests {

std::vector<std::string> help_lines(std::vector<std::string> words) {
  words.emplace_back("--help");
  const ProgramRun run = run_roadbed(words);
  if (run.status != 0) throw std::runtime_error("no help of " + words.front() + ": " + run.err);
  std::vector<std::string> lines;
  std::istringstream stream(run.out);
  for (std::string line; std::getline(stream, line);) lines.push_back(line);
  return lines;
}

std::vector<std::string> commands_in(const std::vector<std::string>& help) {
  std::vector<std::string> names;
  auto line = std::ranges::find(help, "Subcommands:");
  if (line == help.end()) return names;
  for (++line; line != help.end() && line->starts_with("  "); ++line) {
    if ((*line)[2] != ' ') names.push_back(line->substr(2, line->find(' ', 2) - 2));
  }
  return names;
}

std::vector<std::vector<std::string>> all_commands() {
  static std::vector<std::vector<std::string>> commands;  // the program does not change meanwhile
  if (!commands.empty()) return commands;
  for (const std::string& name : commands_in(help_lines({}))) {
    commands.push_back({name});
    for (const std::string& part : commands_in(help_lines({name}))) {
      commands.push_back({name, part});
    }
  }
  return commands;
}

std::vector<std::vector<std::string>> commands_that_run() {
  std::vector<std::vector<std::string>> commands = all_commands();
  std::erase_if(commands,
                [](const auto& words) { return !commands_in(help_lines(words)).empty(); });
  return commands;
}

}  // namespace roadbed::tests
