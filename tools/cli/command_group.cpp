#include "roadbed/tools/cli/command_group.h"

namespace roadbed::tools::inline cli {

void CommandGroup::add(std::string name, std::unique_ptr<Command> command) {
  parts_.push_back({std::move(name), std::move(command), {}});
}

void CommandGroup::declare(Arguments& arguments) {
  arguments.description(description_);
  arguments.example(example_);
  for (Part& part : parts_) {
    part.arguments = arguments.part(part.name);
    part.command->declare(*part.arguments);
  }
}

Exit CommandGroup::run(const Streams& streams, const CommonOptions& common) {
  for (const Part& part : parts_) {
    if (part.arguments->given()) return part.command->run(streams, common);
  }
  return Exit::usage;
}

}  // namespace roadbed::tools::cli
