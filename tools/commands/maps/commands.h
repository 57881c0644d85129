#pragma once

#include <memory>

#include "roadbed/tools/cli/command.h"

namespace roadbed::tools::inline commands::inline maps {

// One per command, each in a file of its own: NAME_command.cpp.
std::unique_ptr<Command> make_import_command();
std::unique_ptr<Command> make_info_command();
std::unique_ptr<Command> make_validate_command();
std::unique_ptr<Command> make_export_command();
std::unique_ptr<Command> make_convert_command();
std::unique_ptr<Command> make_diff_command();
std::unique_ptr<Command> make_map_command();
std::unique_ptr<Command> make_map_clip_command();
std::unique_ptr<Command> make_map_merge_command();
std::unique_ptr<Command> make_map_transform_command();
std::unique_ptr<Command> make_map_tile_command();
std::unique_ptr<Command> make_map_stats_command();
std::unique_ptr<Command> make_map_query_command();
std::unique_ptr<Command> make_map_fix_command();
std::unique_ptr<Command> make_locate_command();

}  // namespace roadbed::tools::commands::maps
