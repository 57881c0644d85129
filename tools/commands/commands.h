#pragma once

#include <memory>

#include "roadbed/tools/batch/job_kinds.h"
#include "roadbed/tools/cli/command.h"
#include "roadbed/tools/commands/audits/commands.h"
#include "roadbed/tools/commands/drives/commands.h"
#include "roadbed/tools/commands/maps/commands.h"
#include "roadbed/tools/commands/occupancy/commands.h"
#include "roadbed/tools/commands/routes/commands.h"

namespace roadbed::tools::inline commands {

std::unique_ptr<Command> make_batch_command();
std::unique_ptr<Command> make_jobs_command();

/// Those that may be jobs of a batch.
const JobKinds& job_kinds();

}  // namespace roadbed::tools::commands
