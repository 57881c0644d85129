#include "roadbed/planning/audit/audit_report.h"

#include <algorithm>
#include <array>
#include <map>

namespace roadbed::planning::inline audit {
namespace {

/// How many stretches of each verdict begin (or, negative, end) at a time.
using Changes = std::map<double, std::array<int, 4>>;

std::size_t index(Verdict verdict) { return static_cast<std::size_t>(verdict); }

Verdict gravest(const std::array<int, 4>& open) {
  for (const Verdict verdict : {Verdict::conflict, Verdict::unknown, Verdict::undecided}) {
    if (open[index(verdict)] > 0) return verdict;
  }
  return Verdict::clear;
}

void append(std::vector<JudgedStretch>& stretches, const JudgedStretch& next) {
  if (!stretches.empty() && stretches.back().verdict == next.verdict) {
    stretches.back().to_s = next.to_s;
  } else {
    stretches.push_back(next);
  }
}

}  // namespace

std::string_view to_string(UnknownPolicy policy) {
  constexpr std::array<std::string_view, 3> names{"free", "occupied", "report"};
  return names[static_cast<std::size_t>(policy)];
}

AuditReport judged(AuditReport report, const geometry::Trajectory& drive) {
  if (!report.is_measured_enough()) report.unknown = {{drive.start_s(), drive.end_s()}};
  report.verdict = verdict_of(report);
  return report;
}

AuditReport judged_between_poses(AuditReport report, const std::vector<Stretch>& between_poses) {
  report.between_poses = between_poses;
  report.unknown.insert(report.unknown.end(), between_poses.begin(), between_poses.end());
  std::ranges::stable_sort(report.unknown, {}, &Stretch::from_s);
  report.verdict = verdict_of(report);
  return report;
}

std::vector<Stretch> joined(std::vector<Stretch> stretches) {
  std::ranges::stable_sort(stretches, {}, &Stretch::from_s);
  std::vector<Stretch> apart;
  for (const Stretch& next : stretches) {
    if (apart.empty() || next.from_s > apart.back().to_s) {
      apart.push_back(next);
    } else {
      apart.back().to_s = std::max(apart.back().to_s, next.to_s);
    }
  }
  return apart;
}

std::vector<JudgedStretch> judged_stretches(const AuditReport& report, double start_s,
                                            double end_s) {
  if (start_s >= end_s) return {{start_s, end_s, report.verdict}};
  Changes changes{{start_s, {}}, {end_s, {}}};
  const auto add = [&](const auto& stretches, Verdict verdict) {
    for (const auto& stretch : stretches) {
      ++changes[std::clamp(stretch.from_s, start_s, end_s)][index(verdict)];
      --changes[std::clamp(stretch.to_s, start_s, end_s)][index(verdict)];
    }
  };
  add(report.conflicts, Verdict::conflict);
  add(report.unknown, Verdict::unknown);
  add(report.undecided, Verdict::undecided);

  std::vector<JudgedStretch> stretches;
  std::array<int, 4> open{};
  for (auto change = changes.begin(); std::next(change) != changes.end(); ++change) {
    for (std::size_t i = 0; i < open.size(); ++i) open[i] += change->second[i];
    append(stretches, {change->first, std::next(change)->first, gravest(open)});
  }
  return stretches;
}

}  // namespace roadbed::planning::audit
