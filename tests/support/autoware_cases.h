#pragma once

#include <functional>
#include <string>
#include <vector>

#include "roadbed/map/validation/rule.h"
#include "roadbed/tests/support/made_vector_map.h"

namespace roadbed::tests {

/// One thing made wrong in a faultless map, and Autoware's issue that has to be found there.
struct AutowareCase {
  std::string issue;    ///< "Lane.BorderSharing-001"
  std::string element;  ///< "lane 12"
  std::function<void(MadeVectorMap& map)> spoil;
};

/// What Autoware's rules find in a map.
std::vector<map::validation::Finding> autoware_findings(const MadeVectorMap& map);

/// Fails for every case whose issue is not found, or not on its element, and on its line; and for
/// each that is found in the faultless map.
void expect_each_issue_is_found(const std::vector<AutowareCase>& cases);

}  // namespace roadbed::tests
