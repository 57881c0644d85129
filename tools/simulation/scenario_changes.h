#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

#include "roadbed/tools/simulation/scenario.h"

namespace roadbed::tools::inline simulation {

/// What a scenario is driven with otherwise than its file says.
struct ScenarioChanges {
  std::optional<geometry::VehicleShape> vehicle = {};
  std::optional<ScenarioNoise> noise = {};
  std::optional<std::uint64_t> seed = {};

  /// @throws InputError if there is a seed, and nothing that is left to chance: all seeds would
  ///         give the same drive.
  void apply_to(Scenario& scenario) const;
};

/// A seed as the command line has it: a whole number from 0 to 2⁵³, as in scenario files; none for
/// any other text.
std::optional<std::uint64_t> parse_seed(std::string_view text);

/// Reads noise: one JSON object with the keys of a scenario's `noise`.
/// @throws InputError naming the key, or the byte where the text is not JSON.
ScenarioNoise read_noise_json(const std::filesystem::path& file);

}  // namespace roadbed::tools
