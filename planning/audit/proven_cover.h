#pragma once

// Private to planning/audit.

#include <vector>

#include "roadbed/planning/audit/audit_report.h"
#include "roadbed/planning/audit/clearance_probe.h"
#include "roadbed/planning/audit/proven_span.h"

namespace roadbed::planning::inline audit {

/// Proven spans of a drive, and the stretches that could not be proven.
struct ProvenCover {
  std::vector<ProvenSpan> proven;
  std::vector<Stretch> left;
};

/// Covers a drive with spans that are nowhere nearer than `goal_m`, and over 0, but for what is
/// left out already.
/// @param left_out  in order of time.
ProvenCover proven_cover(const ClearanceProbe& probe, double goal_m,
                         const std::vector<Stretch>& left_out);

}  // namespace roadbed::planning::audit
