#pragma once

#include <compare>
#include <cstddef>
#include <string>
#include <vector>

#include "roadbed/map/repair/one_repair.h"
#include "roadbed/map/validation/rule.h"

namespace roadbed::map::inline repair {

/// How many findings there are.
struct FindingCounts {
  std::size_t errors = 0, warnings = 0, infos = 0;
  auto operator<=>(const FindingCounts&) const = default;
};
FindingCounts count(const std::vector<validation::Finding>& findings);

struct RepairedFile {
  std::string bytes;            ///< UTF-8; as they were but for the repairs
  std::vector<Repair> repairs;  ///< in the order in which they were made
  FindingCounts before, after;
};

/// Mends what `validate` finds in an OpenDRIVE, Lanelet2 or CommonRoad file and leaves no choice:
/// repairs are proposed from the file's document, made in its text, and kept only where there are
/// fewer findings afterwards, graver ones first; what makes it worse stays a finding. Then again,
/// until nothing is proposed. At most 64 validations.
/// @throws InputError if the file is of another format, or cannot be read as a map.
RepairedFile repair_file(std::string bytes, const std::string& name,
                         const RepairOptions& options = {});

}  // namespace roadbed::map::repair
