#pragma once

#include <string>
#include <vector>

#include "roadbed/map/repair/text_edits.h"
#include "roadbed/map/validation/rule.h"

namespace roadbed::map::inline repair {

/// What may be changed, and for what.
struct RepairOptions {
  double tolerance_m = 0.1;              ///< no point of a border moves farther
  validation::ValidateOptions validate;  ///< what counts as a fault
};

/// One change of a file's text that mends a fault.
struct Repair {
  std::string rule;      ///< of `validate`, which found the fault
  std::string element;   ///< "lane 12/0/-1"
  long line = 0;         ///< in the file as it was before this round of repairs
  std::string what;      ///< was done: "now names lane 3 as its successor, which names it back"
  double moved_m = 0.0;  ///< how far a point of a border moved at most
  std::vector<TextEdit> edits;
};

}  // namespace roadbed::map::repair
