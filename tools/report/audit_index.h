#pragma once

#include <string>
#include <vector>

#include "roadbed/tools/report/report.h"

namespace roadbed::tools::inline report {

/// An audited drive, as a page of many lists it.
struct IndexedAudit {
  std::string name;
  Tone tone = Tone::open;
  std::string outcome;  ///< "clear", "conflict", …, "unusable"
  std::string least;    ///< "0.31 m at 4.20 s, left side"; empty if it is unusable
  std::string text;     ///< all that is to be said, lines
  std::vector<ReportPicture> pictures;
};

/// One HTML page of all audits: a table that leads to what was found in each, with its close-ups.
/// It needs no other file, no network and no script. Same input, same bytes.
/// @param occupancy  the name of its file; `version` of the program.
std::string audit_index_html(const std::vector<IndexedAudit>& audits, const std::string& occupancy,
                             const std::string& version);

}  // namespace roadbed::tools::report
