#pragma once

#include <memory>

#include "roadbed/tools/cli/command.h"

namespace roadbed::tools::inline commands::inline drives {

// One per command, each in a file of its own: NAME_command.cpp.
std::unique_ptr<Command> make_plan_command();
std::unique_ptr<Command> make_control_command();
std::unique_ptr<Command> make_drive_command();
std::unique_ptr<Command> make_simulate_command();
std::unique_ptr<Command> make_pilot_command();
std::unique_ptr<Command> make_figures_command();
std::unique_ptr<Command> make_report_command();
std::unique_ptr<Command> make_report_drive_command();

}  // namespace roadbed::tools::commands::drives
