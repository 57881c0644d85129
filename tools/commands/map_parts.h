#pragma once

#include <memory>

#include "roadbed/tools/cli/command.h"

namespace roadbed::tools::inline commands {

// Parts of `map` that make a new map, each in a file of its own: map_NAME_command.cpp.
std::unique_ptr<Command> make_map_clip_command();
std::unique_ptr<Command> make_map_merge_command();
std::unique_ptr<Command> make_map_transform_command();
std::unique_ptr<Command> make_map_tile_command();
std::unique_ptr<Command> make_map_stats_command();
std::unique_ptr<Command> make_map_query_command();
std::unique_ptr<Command> make_map_fix_command();

}  // namespace roadbed::tools::commands
