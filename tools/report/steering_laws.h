#pragma once

#include <array>

#include "roadbed/control/tracking_run.h"
#include "roadbed/tools/report/paper_figures.h"

namespace roadbed::tools::inline report {

/// A steering law as Fig. 14 draws it.
struct LawLook {
  control::SteeringLaw law;
  const char *name, *colour;
};

inline constexpr std::array<LawLook, 3> kSteeringLaws{{
    {control::SteeringLaw::stanley, "modified Stanley, eq. 32", kBlue},
    {control::SteeringLaw::original_stanley, "original Stanley, eq. 31", kRed},
    {control::SteeringLaw::pure_pursuit, "pure pursuit", kGreen},
}};

}  // namespace roadbed::tools::report
