#include <array>
#include <optional>

#include "roadbed/tools/commands/occupancy/commands.h"

namespace roadbed::tools::inline commands::inline occupancy {
namespace {

class OccupancyCommand : public Command {
 public:
  void declare(Arguments& arguments) override {
    arguments.description(
        "Make obstacle occupancy from point clouds, say what one holds, write it for others, "
        "compare, cut and put together");
    arguments.example(
        "  roadbed occupancy build scan.pcd -o scan.bt\n"
        "  roadbed occupancy info scan.bt");
    for (Part& part : parts_) {
      part.arguments = arguments.part(part.name);
      part.command->declare(*part.arguments);
    }
  }

  Exit run(const Streams& streams, const CommonOptions& common) override {
    for (const Part& part : parts_) {
      if (part.arguments->given()) return part.command->run(streams, common);
    }
    return Exit::usage;
  }

 private:
  struct Part {
    const char* name;
    std::unique_ptr<Command> command;
    std::optional<Arguments> arguments = {};
  };
  std::array<Part, 7> parts_{Part{"build", make_occupancy_build_command()},
                             Part{"info", make_occupancy_info_command()},
                             Part{"export", make_occupancy_export_command()},
                             Part{"diff", make_occupancy_diff_command()},
                             Part{"crop", make_occupancy_crop_command()},
                             Part{"merge", make_occupancy_merge_command()},
                             Part{"objects", make_occupancy_objects_command()}};
};

}  // namespace

std::unique_ptr<Command> make_occupancy_command() { return std::make_unique<OccupancyCommand>(); }

}  // namespace roadbed::tools::commands::occupancy
