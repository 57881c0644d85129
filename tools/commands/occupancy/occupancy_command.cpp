#include "roadbed/tools/cli/command_group.h"
#include "roadbed/tools/commands/occupancy/commands.h"

namespace roadbed::tools::inline commands::inline occupancy {

std::unique_ptr<Command> make_occupancy_command() {
  auto group = std::make_unique<CommandGroup>(
      "Make obstacle occupancy from point clouds, say what one holds, write it for others, "
      "compare, cut and put together",
      "  roadbed occupancy build scan.pcd -o scan.bt\n"
      "  roadbed occupancy info scan.bt");
  group->add("build", make_occupancy_build_command());
  group->add("info", make_occupancy_info_command());
  group->add("export", make_occupancy_export_command());
  group->add("diff", make_occupancy_diff_command());
  group->add("crop", make_occupancy_crop_command());
  group->add("merge", make_occupancy_merge_command());
  group->add("objects", make_occupancy_objects_command());
  return group;
}

}  // namespace roadbed::tools::commands::occupancy
