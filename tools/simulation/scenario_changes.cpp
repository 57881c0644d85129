#include "roadbed/tools/simulation/scenario_changes.h"

#include <algorithm>
#include <charconv>

#include "roadbed/map/files/input_error.h"
#include "roadbed/map/files/read_file.h"
#include "roadbed/tools/files/json_node.h"

namespace roadbed::tools::inline simulation {
namespace {

bool is_random(const ScenarioNoise& noise) {
  const auto all = {noise.gap_m,        noise.relative_speed_mps, noise.acceleration_mps2,
                    noise.position_m,   noise.heading_rad,        noise.speed_mps,
                    noise.dropout_share};
  return std::ranges::any_of(all, [](double amount) { return amount > 0.0; });
}

}  // namespace

void ScenarioChanges::apply_to(Scenario& scenario) const {
  if (vehicle) scenario.vehicle = *vehicle;
  if (noise) scenario.noise = *noise;
  if (!seed) return;
  if (!is_random(scenario.noise)) {
    throw map::InputError({.file = scenario.file.string(),
                           .place = {},
                           .element = {},
                           .found = "nothing is left to chance, and a seed is given",
                           .needed = "noise, as all seeds give the same drive without it",
                           .remedy = "leave --seed out, or give --noise"});
  }
  scenario.seed = *seed;
}

std::optional<std::uint64_t> parse_seed(std::string_view text) {
  std::uint64_t seed = 0;
  const char* const end = text.data() + text.size();
  const auto parsed = std::from_chars(text.data(), end, seed);
  const bool is_seed = parsed.ec == std::errc() && parsed.ptr == end && seed <= kLargestSeed;
  return is_seed ? std::optional(seed) : std::nullopt;
}

ScenarioNoise read_noise_json(const std::filesystem::path& file) {
  const nlohmann::json document = parse_json_strictly(map::read_file(file), file.string());
  return noise_in(JsonNode(document, file.string()));
}

}  // namespace roadbed::tools
