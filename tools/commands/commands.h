#pragma once

#include <memory>

#include "roadbed/tools/batch/job_kinds.h"
#include "roadbed/tools/cli/command.h"

namespace roadbed::tools::inline commands {

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
std::unique_ptr<Command> make_route_command();
std::unique_ptr<Command> make_reach_command();
std::unique_ptr<Command> make_reference_command();
std::unique_ptr<Command> make_plan_command();
std::unique_ptr<Command> make_control_command();
std::unique_ptr<Command> make_drive_command();
std::unique_ptr<Command> make_simulate_command();
std::unique_ptr<Command> make_pilot_command();
std::unique_ptr<Command> make_occupancy_command();
std::unique_ptr<Command> make_occupancy_build_command();
std::unique_ptr<Command> make_occupancy_info_command();
std::unique_ptr<Command> make_occupancy_export_command();
std::unique_ptr<Command> make_occupancy_diff_command();
std::unique_ptr<Command> make_occupancy_crop_command();
std::unique_ptr<Command> make_occupancy_merge_command();
std::unique_ptr<Command> make_occupancy_objects_command();
std::unique_ptr<Command> make_audit_command();
std::unique_ptr<Command> make_figures_command();
std::unique_ptr<Command> make_report_command();
std::unique_ptr<Command> make_report_drive_command();
std::unique_ptr<Command> make_batch_command();
std::unique_ptr<Command> make_jobs_command();

/// Those that may be jobs of a batch.
const JobKinds& job_kinds();

}  // namespace roadbed::tools::commands
