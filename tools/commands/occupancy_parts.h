#pragma once

#include "roadbed/tools/cli/command.h"

namespace roadbed::tools::inline commands {

// The commands below `occupancy`, each in a file of its own: occupancy_NAME_command.cpp.
std::unique_ptr<Command> make_occupancy_build_command();
std::unique_ptr<Command> make_occupancy_info_command();

}  // namespace roadbed::tools
