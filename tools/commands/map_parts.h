#pragma once

#include "roadbed/tools/cli/command.h"

namespace roadbed::tools::inline commands {

// The commands below `map`, each in a file of its own: map_NAME_command.cpp.
std::unique_ptr<Command> make_map_diff_command();

}  // namespace roadbed::tools::commands
