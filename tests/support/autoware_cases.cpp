#include "roadbed/tests/support/autoware_cases.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "roadbed/map/validate_file.h"
#include "roadbed/tests/support/autoware_town.h"

namespace roadbed::tests {
namespace {

using map::validation::Finding;

/// Issues that nobody requires any more are looked for only where they are named.
map::validation::ValidateOptions options_for(const std::string& issue) {
  map::validation::ValidateOptions options;
  options.choice.profile = map::validation::Profile::autoware;
  if (!issue.empty()) options.choice.only = {issue};
  return options;
}

std::vector<Finding> found_in(const MadeVectorMap& map, const std::string& issue) {
  auto findings = map::validate_bytes(map.text(), "town.osm", options_for(issue)).findings;
  std::erase_if(findings, [](const Finding& finding) { return finding.autoware_issue.empty(); });
  return findings;
}

}  // namespace

std::vector<Finding> autoware_findings(const MadeVectorMap& map) { return found_in(map, {}); }

void expect_each_issue_is_found(const std::vector<AutowareCase>& cases) {
  for (const AutowareCase& made : cases) {
    SCOPED_TRACE(made.issue);
    MadeVectorMap town = autoware_town();
    made.spoil(town);
    const auto findings = found_in(town, made.issue);
    const auto on_element = std::ranges::find(findings, made.element, &Finding::element);
    if (on_element == findings.end()) {
      ADD_FAILURE() << "not found on " << made.element;
      for (const Finding& finding : findings) ADD_FAILURE() << "but on " << finding.element;
      continue;
    }
    EXPECT_EQ(on_element->autoware_issue, made.issue);
    EXPECT_GT(on_element->line, 0);
    EXPECT_GT(on_element->message.size(), 20u);
  }
}

}  // namespace roadbed::tests
