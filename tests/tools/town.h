#pragma once

#include <string>

#include "roadbed/tests/support/program_run.h"
#include "roadbed/tests/support/real_data.h"

namespace roadbed::tests {

inline const std::string kTown = data_folder() / "town.xodr";
inline const std::string kGoal = "lane:7/0/1@35";  // a place in it

inline std::string town_bytes() { return bytes_of(kTown); }

}  // namespace roadbed::tests
