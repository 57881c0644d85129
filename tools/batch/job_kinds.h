#pragma once

#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "roadbed/tools/cli/command.h"

namespace roadbed::tools::inline batch {

/// A command that may be a job, with the arguments that it declares.
struct JobKind {
  std::string name;
  std::unique_ptr<Command> (*make)() = nullptr;
  std::vector<ArgumentInfo> arguments;

  /// The option of this name; null if there is none.
  const ArgumentInfo* option(std::string_view long_name) const;

  /// The positional argument, of which each of these commands has just one.
  const ArgumentInfo& positional() const;
};

/// All commands that may be jobs.
class JobKinds {
 public:
  /// A command and what it is called.
  struct Maker {
    std::string name;
    std::unique_ptr<Command> (*make)() = nullptr;
  };
  explicit JobKinds(const std::vector<Maker>& makers);

  /// Null if there is none of this name.
  const JobKind* find(std::string_view name) const;

  const std::vector<JobKind>& all() const { return kinds_; }

 private:
  std::vector<JobKind> kinds_;
};

}  // namespace roadbed::tools::batch
