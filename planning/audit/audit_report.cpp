#include "roadbed/planning/audit/audit_report.h"

#include <array>

namespace roadbed::planning::inline audit {

std::string_view name(UnknownPolicy policy) {
  constexpr std::array<std::string_view, 3> names{"free", "occupied", "report"};
  return names[static_cast<std::size_t>(policy)];
}

std::string_view name(Verdict verdict) {
  constexpr std::array<std::string_view, 4> names{"clear", "conflict", "unknown", "undecided"};
  return names[static_cast<std::size_t>(verdict)];
}

Verdict judge(const AuditReport& report) {
  if (!report.conflicts.empty()) return Verdict::conflict;
  if (!report.unknown.empty()) return Verdict::unknown;
  return report.undecided.empty() ? Verdict::clear : Verdict::undecided;
}

AuditReport judged(AuditReport report, const geometry::Trajectory& drive) {
  if (!report.is_measured_enough()) report.unknown = {{drive.start_s(), drive.end_s()}};
  report.verdict = judge(report);
  return report;
}

}  // namespace roadbed::planning::audit
