#pragma once

#include <optional>
#include <string>
#include <vector>

#include "roadbed/tools/files/json.h"
#include "roadbed/tools/simulation/drive.h"

namespace roadbed::tools::inline simulation {

/// Who is followed, null for nobody; and what became of each hypothesis: keys in README.md.
Json lead_json(const std::optional<planning::DriveLead>& lead);
Json hypotheses_json(const std::vector<planning::HypothesisOutcome>& hypotheses);

/// What was decided in one planning cycle, and why: keys in README.md. Numbers are written so that
/// reading them gives the same ones, bit for bit.
/// @param row  of the drive, at that time.
Json cycle_json(const DriveCycle& cycle, const DriveSample& row);

/// All cycles of a drive, one line of JSON each.
std::string cycle_log(const Drive& drive);

}  // namespace roadbed::tools::simulation
