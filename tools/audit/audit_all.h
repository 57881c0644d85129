#pragma once

#include <functional>
#include <vector>

#include "roadbed/tools/audit/audit_subjects.h"
#include "roadbed/tools/audit/audited_drive.h"

namespace roadbed::tools::inline audit {

/// Audits many drives; one that is unusable does not stop the others. Those near to each other have
/// their distances to occupied space measured once (`drive_groups`). What is found is the same as
/// by `audit_one`, and for any number of threads. `done_one` is called in the threads.
std::vector<AuditedDrive> audit_all(const AuditDemand& demand,
                                    const std::vector<AuditSubject>& subjects, int threads,
                                    const std::function<void()>& done_one);

}  // namespace roadbed::tools::audit
