#include "roadbed/tools/commands/commands.h"

namespace roadbed::tools::inline commands {

const JobKinds& job_kinds() {
  static const JobKinds kinds({{"import", make_import_command},
                               {"validate", make_validate_command},
                               {"route", make_route_command},
                               {"simulate", make_simulate_command},
                               {"audit", make_audit_command}});
  return kinds;
}

}  // namespace roadbed::tools
