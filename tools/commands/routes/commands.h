#pragma once

#include <memory>

#include "roadbed/tools/cli/command.h"

namespace roadbed::tools::inline commands::inline routes {

// One per command, each in a file of its own: NAME_command.cpp.
std::unique_ptr<Command> make_route_command();
std::unique_ptr<Command> make_reach_command();
std::unique_ptr<Command> make_reference_command();

}  // namespace roadbed::tools::commands::routes
