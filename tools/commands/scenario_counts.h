#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

namespace roadbed::tools::inline commands {

/// What a CommonRoad file holds beyond its map: time step, obstacles by role, planning problems;
/// null for any other file.
/// @throws InputError if the scenario is unusable.
nlohmann::ordered_json scenario_counts(const std::string& bytes, const std::string& name);

}  // namespace roadbed::tools::commands
