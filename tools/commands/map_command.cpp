#include <optional>

#include "roadbed/tools/commands/commands.h"
#include "roadbed/tools/commands/map_parts.h"

namespace roadbed::tools::inline commands {
namespace {

class MapCommand : public Command {
 public:
  void declare(Arguments& arguments) override {
    arguments.description("Compare maps");
    arguments.example("  roadbed map diff old.xodr new.xodr");
    diff_arguments_ = arguments.part("diff");
    diff_->declare(*diff_arguments_);
  }

  Exit run(const Streams& streams, const CommonOptions& common) override {
    return diff_arguments_->given() ? diff_->run(streams, common) : Exit::usage;
  }

 private:
  std::unique_ptr<Command> diff_ = make_map_diff_command();
  std::optional<Arguments> diff_arguments_;
};

}  // namespace

std::unique_ptr<Command> make_map_command() { return std::make_unique<MapCommand>(); }

}  // namespace roadbed::tools::commands
