#include "roadbed/tools/batch/job_kinds.h"

#include <algorithm>
#include <stdexcept>

namespace roadbed::tools::inline batch {
namespace {

JobKind kind(std::string name, std::unique_ptr<Command> (*make)()) {
  ArgumentSet set;
  const std::unique_ptr<Command> command = make();
  command->declare(set.arguments());
  const auto& declared = set.arguments().declared();
  return {.name = std::move(name), .make = make, .arguments = {declared.begin(), declared.end()}};
}

}  // namespace

const ArgumentInfo* JobKind::option(std::string_view long_name) const {
  const auto found = std::ranges::find_if(arguments, [&](const ArgumentInfo& argument) {
    return !argument.is_positional && argument.name == long_name;
  });
  return found == arguments.end() ? nullptr : &*found;
}

const ArgumentInfo& JobKind::positional() const {
  static const ArgumentInfo none;
  const auto found = std::ranges::find_if(arguments, &ArgumentInfo::is_positional);
  return found == arguments.end() ? none : *found;
}

JobKinds::JobKinds(const std::vector<Maker>& makers) {
  for (const Maker& maker : makers) kinds_.push_back(kind(maker.name, maker.make));
}

const JobKind* JobKinds::find(std::string_view name) const {
  const auto found = std::ranges::find(kinds_, name, &JobKind::name);
  return found == kinds_.end() ? nullptr : &*found;
}

}  // namespace roadbed::tools::batch
