#pragma once

#include <memory>

#include "roadbed/tools/cli/command.h"

namespace roadbed::tools::inline commands::inline audits {

// One per command, each in a file of its own: NAME_command.cpp.
std::unique_ptr<Command> make_audit_command();

}  // namespace roadbed::tools::commands::audits
