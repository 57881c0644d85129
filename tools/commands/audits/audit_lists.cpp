#include "roadbed/tools/commands/audits/audit_output.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <string_view>
#include <utility>
#include <vector>

#include "roadbed/tools/files/json.h"

namespace roadbed::tools::inline commands::inline audits {
namespace {

constexpr std::array<std::string_view, 5> kOutcomes{"clear", "conflict", "unknown", "undecided",
                                                    "unusable"};

std::ptrdiff_t parts_counted(const std::vector<AuditedDrive>& audits, std::string_view outcome) {
  return std::ranges::count(audits, outcome, &AuditedDrive::outcome);
}

std::string_view gravest(const std::vector<AuditedDrive>& audits) {
  for (const std::string_view outcome : {"unusable", "conflict", "unknown", "undecided"}) {
    if (parts_counted(audits, outcome) > 0) return outcome;
  }
  return "clear";
}

std::string table_row(const AuditedDrive& audited, std::size_t width) {
  const std::string head = fmt::format("{:<{}}  {:<9}", audited.name, width, audited.outcome());
  if (!audited.fault.empty()) return fmt::format("{}  {}\n", head, audited.fault);
  const planning::AuditReport report = audited.whole();
  std::string conflict;
  if (!report.conflicts.empty()) {
    const geometry::TrajectoryPoint from = audited.drive.at(report.conflicts.front().from_s);
    conflict = fmt::format("{:.3f} s at ({:.2f}, {:.2f}), {}", from.t_s, from.x_m, from.y_m,
                           report.conflicts.front().part);
  }
  std::string row = fmt::format(
      "{}  {:>11}  {:>9.3f}  {:>7.1f} %  {}", head,
      fmt::format("{}{:.3f}", report.beyond_horizon ? "over " : "", report.least_clearance_m),
      report.least_clearance_at_s, 100.0 * report.unknown_fraction, conflict);
  row.erase(row.find_last_not_of(' ') + 1);
  return row + "\n";
}

}  // namespace

Json audits_json(const std::vector<AuditedDrive>& audits) {
  Json json;
  json["verdict"] = gravest(audits);
  json["counts"] = Json::object();
  for (const std::string_view outcome : kOutcomes) {
    json["counts"][std::string(outcome)] = parts_counted(audits, outcome);
  }
  json["audits"] = Json::array();
  for (const AuditedDrive& audited : audits) {
    Json one{{"drive", audited.name}};
    if (audited.fault.empty()) {
      one.update(audit_json(audited));
    } else {
      one.update(Json{{"verdict", audited.outcome()}, {"fault", audited.fault}});
    }
    json["audits"].push_back(std::move(one));
  }
  return json;
}

IndexedAudit indexed(const AuditedDrive& audited) {
  IndexedAudit index{.name = audited.name,
                     .tone = audited.is_clear() ? Tone::good : Tone::bad,
                     .outcome = std::string(audited.outcome()),
                     .least = {},
                     .text = audited.fault,
                     .pictures = {}};
  if (!audited.fault.empty()) return index;
  if (index.outcome == "unknown" || index.outcome == "undecided") index.tone = Tone::open;
  index.least = least_text(audited);
  index.text = audit_text(audited);
  return index;
}

std::string audits_table(const std::vector<AuditedDrive>& audits) {
  std::size_t width = 5;
  for (const AuditedDrive& audited : audits) width = std::max(width, audited.name.size());
  std::string text = fmt::format("{:<{}}  {:<9}  {:>11}  {:>9}  {:>9}  {}\n", "drive", width,
                                 "verdict", "least [m]", "at [s]", "unknown", "first conflict");
  for (const AuditedDrive& audited : audits) text += table_row(audited, width);
  text += fmt::format("{} drives:", audits.size());
  for (const std::string_view outcome : kOutcomes) {
    text += fmt::format("{} {} {}", outcome == kOutcomes.front() ? "" : ",",
                        parts_counted(audits, outcome), outcome);
  }
  return text + "\n";
}

}  // namespace roadbed::tools::commands::audits
