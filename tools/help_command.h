#pragma once

#include <memory>

#include "roadbed/tools/cli/arguments.h"
#include "roadbed/tools/cli/command.h"

namespace roadbed::tools {

/// The command `help`: what `--help` says of a command, and, for who installs the program, manual
/// pages and completions of shells.
/// @param program  lives as long as the command; all commands are declared on it before it runs.
std::unique_ptr<Command> make_help_command(const Arguments& program);

}  // namespace roadbed::tools
