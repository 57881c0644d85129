#pragma once

#include <string>
#include <vector>

namespace roadbed::tests {

/// The lines of a command's help; `words` are the command's, empty for the program.
std::vector<std::string> help_lines(std::vector<std::string> words);

/// The names that stand under "Subcommands:".
std::vector<std::string> commands_in(const std::vector<std::string>& help);

/// Every command's words, those of its parts too: {"occupancy"}, {"occupancy", "build"}.
std::vector<std::vector<std::string>> all_commands();

/// Those that do something: not {"occupancy"}, which only has parts.
std::vector<std::vector<std::string>> commands_that_run();

}  // namespace roadbed::tests
