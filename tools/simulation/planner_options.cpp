#include "roadbed/tools/simulation/planner_options.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>

#include "roadbed/map/files/read_file.h"

namespace roadbed::tools::inline simulation {
namespace {

using planning::CostTerm;
using planning::DrivingOptions;

constexpr Range kWeights{0.0, 1e6};

struct Limit {
  std::string_view key;
  double DrivingOptions::*member;
  Range range;
};
constexpr std::array<Limit, 7> kLimits{
    {{"desired_speed_mps", &DrivingOptions::desired_speed_mps, {0.5, 100.0}},
     {"max_lateral_acceleration_mps2", &DrivingOptions::max_lateral_acceleration_mps2, {0.1, 10.0}},
     {"comfort_acceleration_mps2", &DrivingOptions::comfort_acceleration_mps2, {0.1, 2.4}},
     {"comfort_deceleration_mps2", &DrivingOptions::comfort_deceleration_mps2, {0.1, 10.0}},
     {"clearance_m", &DrivingOptions::clearance_m, {0.0, 5.0}},
     {"headway_s", &DrivingOptions::headway_s, {0.5, 5.0}},
     {"standstill_gap_m", &DrivingOptions::standstill_gap_m, {1.0, 20.0}}}};

PlannerChanges style(const JsonNode& node) {
  const std::string name = node.text();
  const auto of = [](double lateral_mps2, double acceleration_mps2, double deceleration_mps2,
                     double headway_s) {
    return PlannerChanges{
        .limits = {{&DrivingOptions::max_lateral_acceleration_mps2, lateral_mps2},
                   {&DrivingOptions::comfort_acceleration_mps2, acceleration_mps2},
                   {&DrivingOptions::comfort_deceleration_mps2, deceleration_mps2},
                   {&DrivingOptions::headway_s, headway_s}}};
  };
  if (name == "gentle") return of(1.5, 1.0, 1.0, 2.0);
  if (name == "normal") return of(2.5, 1.5, 1.5, 1.5);
  if (name == "sporty") return of(3.5, 2.2, 2.2, 1.2);
  node.refuse(fmt::format("is \"{}\"", name), "gentle, normal or sporty", "choose one");
}

CostTerm term(const std::string& key, const JsonNode& node) {
  std::vector<std::string_view> names;
  for (int i = 0; i < planning::kCostTerms; ++i) {
    names.push_back(planning::to_string(static_cast<CostTerm>(i)));
    if (names.back() == key) return static_cast<CostTerm>(i);
  }
  node.refuse("is no term of the cost", fmt::format("one of {}", fmt::join(names, ", ")),
              "correct or remove the key");
}

}  // namespace

void PlannerChanges::apply_to(DrivingOptions& options) const {
  for (const auto& [member, value] : limits) options.*member = value;
  for (const auto& [named, weight] : weights) planning::of(options.weights, named) = weight;
}

PlannerChanges limits_in(const JsonNode& node, std::initializer_list<std::string_view> others) {
  PlannerChanges changes;
  for (const auto& [key, value] : node.members()) {
    const auto limit = std::ranges::find(kLimits, key, &Limit::key);
    if (limit != kLimits.end()) {
      changes.limits.emplace_back(limit->member, value.number(limit->range));
    } else if (std::ranges::find(others, key) == others.end()) {
      std::vector<std::string_view> known(others);
      std::ranges::transform(kLimits, std::back_inserter(known), &Limit::key);
      value.refuse("is not a known key", fmt::format("one of {}", fmt::join(known, ", ")),
                   "correct or remove it");
    }
  }
  return changes;
}

PlannerChanges parse_planner_options(std::string_view bytes, const std::string& name) {
  const nlohmann::json document = parse_json_strictly(bytes, name);
  const JsonNode root(document, name);
  root.check_version("options");
  root.require_object({"roadbed_options", "style", "limits", "weights"});
  PlannerChanges changes;
  if (const auto node = root.find("style")) changes = style(*node);
  if (const auto node = root.find("limits")) {
    std::ranges::copy(limits_in(*node).limits, std::back_inserter(changes.limits));
  }
  if (const auto node = root.find("weights")) {
    for (const auto& [key, value] : node->members()) {
      changes.weights.emplace_back(term(key, value), value.number(kWeights));
    }
  }
  return changes;
}

PlannerChanges read_planner_options(const std::filesystem::path& file) {
  return parse_planner_options(map::read_file(file), map::input_name(file));
}

}  // namespace roadbed::tools::simulation
