#pragma once

#include <vector>

#include "roadbed/planning/audit/audit_report.h"

namespace roadbed::planning::inline audit {

/// Stretches in order of time; those that meet become one.
std::vector<Stretch> joined(std::vector<Stretch> stretches);

/// A part of a drive with one verdict.
struct JudgedStretch {
  double from_s = 0.0, to_s = 0.0;
  Verdict verdict = Verdict::undecided;
};

/// The whole drive, stretch by stretch, in order of time and without a gap. Where several verdicts
/// meet, the graver one counts: conflict, then unknown, then undecided, then clear.
std::vector<JudgedStretch> judged_stretches(const AuditReport& report, double start_s,
                                            double end_s);

}  // namespace roadbed::planning::audit
