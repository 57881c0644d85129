#include <array>

#include "roadbed/tools/command.h"
#include "roadbed/tools/occupancy_parts.h"

namespace roadbed::tools {
namespace {

class OccupancyCommand : public Command {
 public:
  void declare(CLI::App& app) override {
    app.description("Make obstacle occupancy from point clouds, or say what one holds");
    app.require_subcommand(1);
    app.footer(
        "Example:\n  roadbed occupancy build scan.pcd -o scan.bt\n"
        "  roadbed occupancy info scan.bt");
    for (Part& part : parts_) {
      part.app = app.add_subcommand(part.name);
      part.command->declare(*part.app);
    }
  }

  Exit run(const Streams& streams, const CommonOptions& common) override {
    for (const Part& part : parts_) {
      if (part.app->parsed()) return part.command->run(streams, common);
    }
    return Exit::usage;
  }

 private:
  struct Part {
    const char* name;
    std::unique_ptr<Command> command;
    CLI::App* app = nullptr;
  };
  std::array<Part, 2> parts_{Part{"build", make_occupancy_build_command()},
                             Part{"info", make_occupancy_info_command()}};
};

}  // namespace

std::unique_ptr<Command> make_occupancy_command() { return std::make_unique<OccupancyCommand>(); }

}  // namespace roadbed::tools
