#include "roadbed/tools/commands/maps/finding_baseline.h"

#include <algorithm>
#include <map>
#include <utility>

#include "roadbed/map/files/read_file.h"
#include "roadbed/tools/files/json.h"

namespace roadbed::tools::inline commands::inline maps {

std::vector<KnownFinding> read_baseline(const std::filesystem::path& file) {
  const std::string name = map::input_name(file);
  const nlohmann::json document = parse_json_strictly(map::read_file(file), name);
  const JsonNode root(document, name);
  root.check_version("findings");
  std::vector<KnownFinding> baseline;
  for (const JsonNode& finding : root.at("findings").elements()) {
    const auto issue = finding.find("autoware_issue");
    const bool has_issue = issue && !issue->value().is_null();
    baseline.push_back({finding.at("rule").text(), has_issue ? issue->text() : std::string(),
                        finding.at("element").text()});
  }
  return baseline;
}

BaselineDiff compare_with_baseline(const std::vector<map::validation::Finding>& findings,
                                   std::vector<KnownFinding> baseline) {
  std::map<KnownFinding, std::size_t> left;
  for (KnownFinding& known : baseline) ++left[std::move(known)];
  BaselineDiff diff;
  for (const map::validation::Finding& finding : findings) {
    const auto found = left.find({finding.rule, finding.autoware_issue, finding.element});
    const bool is_known = found != left.end() && found->second > 0;
    if (is_known) --found->second;
    diff.known.push_back(is_known);
  }
  for (const auto& [known, count] : left) diff.gone.insert(diff.gone.end(), count, known);
  return diff;
}

}  // namespace roadbed::tools::commands::maps
