#pragma once

#include <filesystem>
#include <string_view>
#include <utility>
#include <vector>

#include "roadbed/planning/task/driving_task.h"
#include "roadbed/tools/files/json.h"

namespace roadbed::tools::inline simulation {

/// What a planner options file says: some options of how the ego is driven, in place of others.
///
///     {"style": "gentle", "limits": {"clearance_m": 0.5}, "weights": {"offset": 1.5}}
///
/// A style is a named set of options (README.md); what the file names besides stands in its place.
struct PlannerChanges {
  std::vector<std::pair<double planning::DrivingOptions::*, double>> limits = {};
  std::vector<std::pair<planning::CostTerm, double>> weights = {};

  void apply_to(planning::DrivingOptions& options) const;
};

/// @throws InputError naming the file, and the place as a JSON pointer, where a key or a style is
///         not known, or a value is out of its range.
PlannerChanges read_planner_options(const std::filesystem::path& file);

/// The same from bytes; `name` stands for the file in messages.
PlannerChanges parse_planner_options(std::string_view bytes, const std::string& name);

/// The limits that an object names; keys of the list are left to others.
PlannerChanges limits_in(const JsonNode& node, std::initializer_list<std::string_view> others = {});

}  // namespace roadbed::tools::simulation
