#pragma once

#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "roadbed/tools/cli/command.h"

namespace roadbed::tools::inline cli {

/// A command whose parts are commands, of which one is given: `map clip`, `occupancy build`.
class CommandGroup : public Command {
 public:
  /// @param description, example  for its help; parts have their own.
  CommandGroup(std::string description, std::string example)
      : description_(std::move(description)), example_(std::move(example)) {}

  void add(std::string name, std::unique_ptr<Command> command);

  void declare(Arguments& arguments) override;
  Exit run(const Streams& streams, const CommonOptions& common) override;

 private:
  struct Part {
    std::string name;
    std::unique_ptr<Command> command;
    std::optional<Arguments> arguments;
  };

  std::string description_, example_;
  std::vector<Part> parts_;
};

}  // namespace roadbed::tools::cli
