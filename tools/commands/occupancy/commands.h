#pragma once

#include <memory>

#include "roadbed/tools/cli/command.h"

namespace roadbed::tools::inline commands::inline occupancy {

// One per command, each in a file of its own: NAME_command.cpp.
std::unique_ptr<Command> make_occupancy_command();
std::unique_ptr<Command> make_occupancy_build_command();
std::unique_ptr<Command> make_occupancy_info_command();
std::unique_ptr<Command> make_occupancy_export_command();
std::unique_ptr<Command> make_occupancy_diff_command();
std::unique_ptr<Command> make_occupancy_crop_command();
std::unique_ptr<Command> make_occupancy_merge_command();
std::unique_ptr<Command> make_occupancy_objects_command();

}  // namespace roadbed::tools::commands::occupancy
